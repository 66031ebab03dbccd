# SPDX-License-Identifier: GPL-3.0-or-later
"""The light that surfaces send to one another: of the scene, not of a view."""
