# SPDX-License-Identifier: GPL-3.0-or-later
"""What `scripts/bench.py NAME` draws or makes for the docs and the product, a module each."""
