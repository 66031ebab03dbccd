# SPDX-License-Identifier: GPL-3.0-or-later
"""Damaged files of each binary format that is read, and what becomes of them."""
