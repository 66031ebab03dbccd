# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a surface ends or breaks: borders, the clip lines that surfels get there, and surfels along them."""
