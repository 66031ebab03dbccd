# SPDX-License-Identifier: GPL-3.0-or-later
"""Figures that `scripts/bench.py NAME` draws for the docs and the product, one module each."""
