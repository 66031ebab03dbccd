# SPDX-License-Identifier: GPL-3.0-or-later
"""The depth of each sample in a texture of its own, for features that read many of them around each sample."""

from __future__ import annotations

from ..plan.graph import Part, Pass, Texture, fill_all
from ..plan.hosts import Host, Kind
from . import gbuffer, polygons

DEPTHS = Texture("sample_depths", "R32F")


def passes(planning):
    """The pass, which is trimmed if nobody reads it."""
    if not planning.shown:
        return
    samples = planning.settings.multisampling
    own = Part(
        "sample_depths",
        writes=(DEPTHS,),
        constants=(("MEAN_OF", samples),),
        choices=(("samples", "mean" if samples else "each"),),
    )
    sums = gbuffer.depth_parts(planning, Kind.OPAQUE, reads=(gbuffer.COLOR, gbuffer.NORMAL))
    why = "depths around each sample are looked at"
    yield Pass("sample_depths", why, Host.SAMPLE_DEPTHS, fill_all, (own, sums, *polygons.joined(planning)))
