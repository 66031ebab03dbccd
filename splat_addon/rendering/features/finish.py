# SPDX-License-Identifier: GPL-3.0-or-later
"""What surfaces have beside roughness, metallic and reflectance (`scene.finish`): few finishes, many surfels.

The frame's block holds the finishes. If there are several, each sample sums the shares of all but the first, and they
are mixed by these.
"""

from __future__ import annotations

from collections import Counter
from functools import partial

from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS, Host, Kind
from ..plan.planning import any_of
from ..scene import Finish
from ..scene.table import Kinds
from ..shading_models.brdf_table import edge_texels
from ..upload.packing import MAX_FINISHES, finish_matrix
from . import gbuffer, lights, materials, outputs

SHARES = Texture("gbuffer_finish", is_multisampled=True, is_sum=True)


def _matrix(tile, number: int):
    """A finish of the frame; the first in the place of those that it lacks, whose shares are 0."""
    finishes = tile.plan.facts["finishes"]
    return finish_matrix(finishes[number if number < len(finishes) else 0])


VALUES = {f"finish_{number}": ("mat4", partial(_matrix, number=number)) for number in range(MAX_FINISHES)}
INPUTS = {"edge_table": lambda tile: tile.resources.constant(edge_texels)}
#: part of a finish -> the table that its shading looks up
_TABLES = {"specular_tint": "edge_table"}


def found(planning) -> tuple[Finish, ...]:
    """The finishes that the frame tells apart, the most common first; none if all are plain."""
    kept = tuple(finish for finish, _ in planning.scene.table.kinds.find(_counted).most_common(MAX_FINISHES))
    has_any = any(finish.layers for finish in kept)
    return kept if has_any and (len(kept) == 1 or _has_room(planning)) else ()


def _counted(kinds: Kinds) -> Counter[Finish]:
    """How many instances have each finish."""
    counted = Counter()
    for placed, number in kinds:
        for material in placed.materials:
            counted[material.finish] += number
    return counted


def _has_room(planning) -> bool:
    """Whether the other sums of a frame leave room for one more."""
    has_layers = any_of(lambda instance: instance.is_transparent, planning.surfels)
    kinds = BLENDED if has_layers else (Kind.OPAQUE,)
    sums = 2 + any(gbuffer.depths_are_apart(planning, kind) for kind in kinds) + sum(materials.differ(planning))
    return sums + lights.are_linked(planning) + outputs.counts_splats(planning) < outputs.MAX_COLORS


def summed(planning) -> tuple[Finish, ...]:
    """The finishes if there are several, because each sample then sums their shares; otherwise none."""
    kept = planning.find(found) if planning.model.has_finish else ()
    return kept if len(kept) > 1 else ()


def passes(planning):
    """No passes; records what the frame has."""
    planning.facts["finishes"] = kept = planning.find(found)
    planning.facts["summed_finishes"] = summed(planning)
    every = planning.scene.table.kinds.find(_counted)
    if not kept and any(finish.layers for finish in every):
        planning.skip("finishes", _NO_ROOM)
        return ()
    if not kept:
        planning.skip("finish", "all materials are plain")
        return ()
    if not planning.model.has_finish:
        planning.skip("finish", f"{planning.model.name} shading does not look at it")
        return ()
    planning.has("FINISH", f"{len(kept)} of {', '.join(_layers(kept))}")
    if len(every) > len(kept):
        planning.skip("finishes", _TOO_MANY.format(len(every), len(kept)))
    return ()


_TOO_MANY = (
    "materials have {} different combinations of Coat, Sheen and Specular Tint, and a picture shows {}; the others "
    "look like the most similar of these"
)
_NO_ROOM = (
    "Coat, Sheen and Specular Tint are left out, because materials differ in them and pictures with transparency or "
    "float16 sums, light linking and different emissions have no room for that; do without one of these"
)

#: Parts that lie over the rest.
_COVERS = frozenset({"coat", "sheen"})


def _layers(finishes: tuple[Finish, ...]) -> tuple[str, ...]:
    """The optional parts, such as a coat, that any of the finishes has."""
    return tuple(dict.fromkeys(layer for finish in finishes for layer in finish.layers))


def parts(planning, p):
    if not planning.model.has_finish or not planning.find(found):
        return
    drawn = {"inputs": ("materials",), "constants": materials.texels(planning)}
    differ, layers = bool(summed(planning)), _layers(planning.find(found))
    if p.host in SPLAT_HOSTS and p.kind in BLENDED and differ:
        yield Part("finish", writes=(SHARES,), varyings=(("flat", "vec4", "finish"),), **drawn)
    if p.host in LIGHTING_HOSTS:
        tables = (_TABLES[layer] for layer in layers if layer in _TABLES)
        covered = () if _COVERS.isdisjoint(layers) else ("covered",)
        yield Part("finish", (*layers, *covered), inputs=tuple(tables))
    if p.host in LIT_HOSTS and differ:
        yield Part("finish", ("finishes_differ",), reads=(SHARES,))
    if p.host == Host.LIT_SPLATS and differ:
        yield Part("finish", ("finishes_differ",), **drawn)
