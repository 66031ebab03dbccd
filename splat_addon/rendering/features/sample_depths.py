# SPDX-License-Identifier: GPL-3.0-or-later
"""The depth of each sample in a texture of its own, for features that read many of them around each sample."""

from __future__ import annotations

from ..passes.sums import depth_parts
from ..passes.textures import COLOR_SUM, NORMAL_SUM, SAMPLE_DEPTHS
from ..plan.graph import Part, Pass, fill_all
from ..plan.hosts import Host, Kind
from . import polygons


def passes(planning):
    """The pass, which is trimmed if nobody reads it."""
    if not planning.shown:
        return
    samples = planning.settings.multisampling
    own = Part(
        "sample_depths",
        writes=(SAMPLE_DEPTHS,),
        constants=(("MEAN_OF", samples),),
        choices=(("samples", "mean" if samples else "each"),),
    )
    sums = depth_parts(planning, Kind.OPAQUE, reads=(COLOR_SUM, NORMAL_SUM))
    why = "depths around each sample are looked at"
    yield Pass("sample_depths", why, Host.SAMPLE_DEPTHS, fill_all, (own, sums, *polygons.joined(planning)))
