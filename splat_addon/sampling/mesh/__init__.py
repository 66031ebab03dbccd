# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh as plain arrays, and what sampling needs to know about it: usable triangles, parts, solidity."""
