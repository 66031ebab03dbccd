# SPDX-License-Identifier: GPL-3.0-or-later
"""A renderer for interactive views: coarse pictures while it moves or loads, and finer ones when it rests."""
