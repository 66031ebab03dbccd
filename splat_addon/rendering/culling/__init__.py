# SPDX-License-Identifier: GPL-3.0-or-later
"""What a view need not draw, and pictures stay the same: what is behind other surfaces, or outside the picture."""
