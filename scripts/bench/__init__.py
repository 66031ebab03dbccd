# SPDX-License-Identifier: GPL-3.0-or-later
"""Benchmarks that `scripts/bench.py NAME` runs, one module each: tables, and plots of them."""
