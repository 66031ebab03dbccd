# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame needs, as passes over typed textures to which features add parts: made, trimmed, composed and run."""
