# SPDX-License-Identifier: GPL-3.0-or-later
"""Which sums the splats of a frame are added to beside their colours, and where these are stored: targets have room for
a few textures, so that some share one."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import NamedTuple

from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, Kind
from ..plan.planning import Planning, any_of
from ..scene import Finish, Material, Style
from ..scene.kinds import Kinds
from ..scene.lines import Lines
from ..scene.style import AS_THE_PICTURE
from ..shading_models import ShadingModel
from ..upload.packing import MAX_FINISHES, MaterialTexels, shared_emission, shared_material
from .decisions import lights_samples, shadows
from .textures import DEPTH_PLANE_SUM, DEPTH_SUM, MAX_COLORS, PLANE_MORE_SUM, PLANE_SUM


def depths_are_apart(planning: Planning, kind: Kind) -> bool:
    """Whether depths are summed separately from normals."""
    return kind == Kind.LAYER or planning.settings.sum_format == "float16"


def depth_sum(planning: Planning) -> Texture:
    """The sum of separate depths, of all passes alike."""
    has_planes = planning.find(shadows).maps and lights_samples(planning, Kind.OPAQUE)
    return DEPTH_PLANE_SUM if has_planes else DEPTH_SUM


def depth_parts(planning: Planning, kind: Kind, **fields) -> Part:
    """The parts for depths, which are stored beside normals or separately. fields: further fields of the part."""
    if not depths_are_apart(planning, kind):
        return Part("depth_in_normals", **fields)
    apart = depth_sum(planning)
    return Part("gbuffer_depth", **{field: (*textures, apart) for field, textures in fields.items()})


def plane_sum(planning: Planning, kind: Kind) -> Texture | None:
    """The separate sum of planes; None if they are stored beside depths, or nothing needs them."""
    is_lit = planning.find(shadows).maps and lights_samples(planning, kind)
    if not is_lit or depths_are_apart(planning, kind):
        return None
    counts = kind == Kind.OPAQUE and counts_splats(planning)
    return PLANE_MORE_SUM if counts or planning.find(are_lifted) else PLANE_SUM


def are_lifted(planning: Planning) -> bool:
    """Whether any surfels lie below the smooth surface of their shading normals."""
    return any_of(lambda instance: instance.surfels.lift is not None, planning.surfels)


def counts_splats(planning: Planning) -> bool:
    """Whether any output needs the number of splats per sample."""
    return "overdraw" in planning.settings.outputs or bool(planning.model.sums)


def are_linked(planning: Planning, model: ShadingModel) -> bool:
    """Whether lights light some objects only."""
    return model.is_lit and any(light.receivers is not None for light in planning.scene.lights)


class Shared(NamedTuple):
    """The material and the emission that all surfels share; None for each that differs."""

    material: Material | None
    emission: tuple[float, float, float] | None


def shared(planning: Planning) -> Shared:
    """What all surfels share."""
    each = tuple(kind.placed for kind in planning.scene.table.kinds)
    return Shared(shared_material(each), shared_emission(each))


class Differ(NamedTuple):
    """Whether materials, and emissions, need sums."""

    materials: bool
    emissions: bool


def differ(planning: Planning, model: ShadingModel) -> Differ:
    """Whether materials, and emissions, need sums for a shading model."""
    found = planning.find(shared)
    return Differ(model.has_material and found.material is None, model.has_material and found.emission is None)


def finishes(planning: Planning) -> tuple[Finish, ...]:
    """The finishes that the frame tells apart, the most common first; none if all are plain."""
    kept = tuple(finish for finish, _ in planning.scene.table.kinds.find(counted_finishes).most_common(MAX_FINISHES))
    has_any = any(finish.layers for finish in kept)
    return kept if has_any and (len(kept) == 1 or _has_room(planning, bool(planning.find(styles)))) else ()


def counted_finishes(kinds: Kinds) -> Counter[Finish]:
    """How many instances have each finish."""
    counted = Counter()
    for placed, number in kinds:
        for material in placed.materials:
            counted[material.finish] += number
    return counted


def _has_room(planning: Planning, has_style: bool) -> bool:
    """Whether the other sums of a frame leave room for one more. has_style: whether styles are among those."""
    has_layers = any_of(lambda instance: instance.is_transparent, planning.surfels)
    kinds = BLENDED if has_layers else (Kind.OPAQUE,)
    model = planning.model
    sums = 2 + any(depths_are_apart(planning, kind) for kind in kinds) + sum(differ(planning, model)) + has_style
    if has_style and planning.scene.polygons and bool(planning.find(shadows).maps) + sums >= MAX_COLORS:
        return False  # polygons have planes beside these
    return sums + are_linked(planning, model) + counts_splats(planning) < MAX_COLORS


def summed_finishes(planning: Planning, model: ShadingModel) -> tuple[Finish, ...]:
    """The finishes if there are several, because each sample then sums their shares; otherwise none."""
    kept = planning.find(finishes) if model.has_finish else ()
    return kept if len(kept) > 1 else ()


def asked_styles(planning: Planning) -> tuple[Style, ...]:
    """The styles of all materials, after that of the picture; none if they are all as the picture."""
    kinds = planning.scene.table.kinds
    found = dict.fromkeys((AS_THE_PICTURE, *(m.style for placed, _ in kinds for m in placed.materials)))
    return tuple(found) if len(found) > 1 else ()


def styles(planning: Planning) -> tuple[Style, ...]:
    """Those that the frame tells apart."""
    asked = planning.find(asked_styles) if planning.shown else ()
    return asked if asked and len(asked) <= MAX_STYLES and _has_room(planning, False) else ()


#: Styles that a picture tells apart: 32-bit sums of their moments are exact enough for so many.
MAX_STYLES = 512


def drawn_lines(planning: Planning) -> Lines | None:
    """The lines of the picture, as wide as the widest of a style; None for none."""
    widths = [style.line.width for style in planning.find(styles) if style.line is not None]
    lines = planning.settings.lines
    widest = max(widths, default=0.0)
    if lines is None:
        return Lines(width=widest) if widest > 0 else None
    return replace(lines, width=max(widest, lines.width))


def material_texels(planning: Planning) -> MaterialTexels:
    """How materials are stored, of all passes alike."""
    model = planning.model
    return MaterialTexels(differ(planning, model).emissions, summed_finishes(planning, model), planning.find(styles))
