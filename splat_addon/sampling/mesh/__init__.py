# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as plain arrays, and what is asked of it before it is sampled: usable triangles, parts, solidity."""
