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
    own = Part("sample_depths", writes=(SAMPLE_DEPTHS,))
    yield of_samples(planning, Host.SAMPLE_DEPTHS, "depths around each sample are looked at", own)


def of_samples(planning, host: Host, why: str, own: Part) -> Pass:
    """A pass that looks at the surface that each sample sees."""
    samples = planning.settings.multisampling
    own = own._replace(constants=(("MEAN_OF", samples),), choices=(("samples", "mean" if samples else "each"),))
    sums = depth_parts(planning, Kind.OPAQUE, reads=(COLOR_SUM, NORMAL_SUM))
    return Pass(host.removesuffix(".frag"), why, host, fill_all, (own, sums, *polygons.joined(planning)))
