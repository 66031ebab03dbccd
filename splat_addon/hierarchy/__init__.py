# SPDX-License-Identifier: GPL-3.0-or-later
"""A filtered hierarchy over any set of surfels, and the cut through it that a view draws.

Levels are merged from below over the cells of a grid (`clusters`, `merging`); what stands apart, such as leaves,
becomes one surfel each (`pieces`) that keeps its area (`loose`). Every merged surfel has bounds on its difference from
the surfels it replaces (`bounds`), and ends at their clip lines (`merged_lines`). What lies around it makes it sharper,
and its bounds larger at borders (`surroundings`). Runs of neighbours in a level are *blocks*, each with a box and a
cone of normals (`blocks`), from which a view selects (`cuts`). When surfels move, the tree stays, and is fitted to them
(`refitting`). Numbers that the surfels have beside their fields have means too (`standing_for`). Surfels of extreme
sizes or places never merge (`extremes`). Those of small objects may do without lines (`lineless`).
"""

from .building import Hierarchy, Told, build_hierarchy
from .cuts import Sight, Split, are_facing, cut_blocks, entries_of
from .extremes import has_extremes
from .lineless import without_lines
from .refitting import refit_hierarchy
from .standing_for import most_common, rounded_means

__all__ = [
    "Hierarchy",
    "Sight",
    "Split",
    "Told",
    "are_facing",
    "build_hierarchy",
    "cut_blocks",
    "entries_of",
    "has_extremes",
    "most_common",
    "refit_hierarchy",
    "rounded_means",
    "without_lines",
]
