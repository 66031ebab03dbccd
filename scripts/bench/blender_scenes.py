# SPDX-License-Identifier: GPL-3.0-or-later
"""What scenes of many objects cost in Blender: reading them, and a field of grass that Geometry Nodes place beside
Cycles.

An animation reads different objects of which one moves. *Read* is the processor time until the scene is known, of the
thread that reads. Of the grass, *processor seconds* are those of the second picture.
"""

from __future__ import annotations

import splat_addon
from measuring import grass, reading

QUICK = {"objects": 4, "blades": [200]}


def arguments(parser) -> None:
    parser.add_argument("--objects", type=int, default=100, help="that an animation reads, of 5,120 triangles each")
    parser.add_argument("--blades", type=int, nargs="*", default=[20_000], help="instances beside Cycles")


def run(options, report) -> None:
    splat_addon.register()
    report.header()
    report.table(reading.COLUMNS, reading.rows(options.objects))
    report.table(grass.COLUMNS, (row for n in options.blades for row in grass.rows(n)))
