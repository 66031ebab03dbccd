# SPDX-License-Identifier: GPL-3.0-or-later
"""The RenderEngine: final renders, the viewport, passes, motion blur."""
