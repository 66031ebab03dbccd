# SPDX-License-Identifier: GPL-3.0-or-later
"""Shading normals that change over each splat (Botsch, Spernat, Kobbelt, "Phong Splatting", 2004)."""

from __future__ import annotations

from ...normal_fields import NORMAL_STEP, share_of
from ..passes.decisions import lights_samples
from ..passes.drawing import pooled
from ..plan.graph import Part
from ..plan.hosts import BLENDED, BLENDING_HOSTS, Host, Kind
from ..plan.planning import count, counted

CONSTANTS = {"NORMAL_STEP": NORMAL_STEP}

_VARYINGS = (("flat", "vec3", "normal_u"), ("flat", "vec3", "normal_v"))


def _has_field(instance) -> bool:
    return instance.surfels.normals_change


def _drawn(tile, placed):
    surfels, levels = placed.instance.surfels, tile.levels(placed.instance)
    return pooled(tile, placed, "normal_fields") or tile.resources.normal_fields(surfels, levels, placed.part)


DRAWN = {"normal_fields": _drawn}
ARRIVES = {"normal_fields": _has_field}


def _count(planning) -> int:
    """The number of instances with such normals, if any normal is looked at where splats have been added up."""
    settings, model = planning.settings, planning.model
    is_lit = model.is_lit and lights_samples(planning, Kind.OPAQUE)
    is_seen = is_lit or model.shows_normals or "normal" in settings.outputs or settings.lines is not None
    return count(_has_field, planning.surfels) if is_seen else 0


passes, is_present = counted(
    "NORMAL_FIELDS",
    _count,
    "normals change over the splats of {count} instances",
    "changing normals",
    "no splats have any, or nothing looks at them",
)


def parts(planning, p):
    if p.host in BLENDING_HOSTS and p.kind in BLENDED:
        words = ("turns_sprites",) if p.host == Host.POINT_SPRITE else ()
        constants = (("NORMAL_SHARE", repr(share_of(planning.settings.as_printed))),)
        yield Part("normal_fields", words, inputs=("normal_fields",), varyings=_VARYINGS, constants=constants)
