# SPDX-License-Identifier: GPL-3.0-or-later
"""What lies on a device between frames, and the texels in which it lies there."""
