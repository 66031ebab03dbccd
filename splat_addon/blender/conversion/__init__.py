# SPDX-License-Identifier: GPL-3.0-or-later
"""What the converting operators do: gather, sample, bake, place; the settings and the predicted count."""
