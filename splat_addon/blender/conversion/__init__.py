# SPDX-License-Identifier: GPL-3.0-or-later
"""The steps of conversion: gather, sample, bake, place; also the settings and the predicted count."""
