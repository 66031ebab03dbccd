# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surfels stand for an object in a view: merged ones, those read from a file, or a few while others load."""
