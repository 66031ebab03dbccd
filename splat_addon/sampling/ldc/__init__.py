# SPDX-License-Identifier: GPL-3.0-or-later
"""The layered depth cube: an exact grid, scan conversion onto it, and the reductions that decide which samples stay."""
