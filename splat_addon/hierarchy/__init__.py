# SPDX-License-Identifier: GPL-3.0-or-later
"""A filtered hierarchy over any set of surfels, and the cut through it that a view draws.

Levels are merged from below over the cells of a grid (`clusters`, `merging`), and every merged surfel has bounds of
what it differs by from those that it stands for (`bounds`). Runs of neighbours in a level are *blocks*, each with a box
and a cone of normals (`blocks`), and of these a view draws some (`cuts`).
"""

from .building import Hierarchy, build_hierarchy
from .cuts import Sight, cut_entries

__all__ = ["Hierarchy", "Sight", "build_hierarchy", "cut_entries"]
