# SPDX-License-Identifier: GPL-3.0-or-later
"""What `scripts/bench.py NAME` measures, a module each: tables, and plots of them."""
