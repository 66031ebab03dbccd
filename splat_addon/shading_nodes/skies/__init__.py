# SPDX-License-Identifier: GPL-3.0-or-later
"""The Sky Texture node: the light of a clear sky and its sun by direction, as Blender models them."""

from .lookup import FUNCTIONS
from .parameters import Air, Daylight, Disc, Sky

__all__ = ["FUNCTIONS", "Air", "Daylight", "Disc", "Sky"]
