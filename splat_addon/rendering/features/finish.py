# SPDX-License-Identifier: GPL-3.0-or-later
"""What surfaces have beside roughness, metallic and reflectance (`scene.finish`): few finishes, many surfels.

The frame's block holds the finishes. If there are several, each sample sums the shares of all but the first, and they
are mixed by these.
"""

from __future__ import annotations

from functools import partial

from ..passes.decisions import model_in
from ..passes.sums import counted_finishes, finishes, material_texels, summed_finishes
from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS, Host
from ..scene import Finish
from ..shading_models.brdf_table import edge_texels
from ..upload.packing import MAX_FINISHES, finish_matrix

SHARES = Texture("gbuffer_finish", is_multisampled=True, is_sum=True)


def _matrix(tile, number: int):
    """A finish of the frame; the first in the place of those that it lacks, whose shares are 0."""
    found = tile.plan.find(finishes)
    return finish_matrix(found[number if number < len(found) else 0])


VALUES = {f"finish_{number}": ("mat4", partial(_matrix, number=number)) for number in range(MAX_FINISHES)}
INPUTS = {"edge_table": lambda tile: tile.resources.constant(edge_texels)}
#: part of a finish -> the table that its shading looks up
_TABLES = {"specular_tint": "edge_table"}


def passes(planning):
    """No passes; records what the frame has."""
    kept, every = planning.find(finishes), planning.scene.table.kinds.find(counted_finishes)
    if not kept and any(finish.layers for finish in every):
        planning.lack("finishes", _NO_ROOM)
        return ()
    if not kept:
        planning.skip("finish", "all materials are plain")
        return ()
    if not planning.model.has_finish:
        planning.skip("finish", f"{planning.model.name} shading does not look at it")
        return ()
    planning.has("FINISH", f"{len(kept)} of {', '.join(_layers(kept))}")
    if len(every) > len(kept):
        planning.lack("finishes", _TOO_MANY.format(len(every), len(kept)))
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


def _layers(found: tuple[Finish, ...]) -> tuple[str, ...]:
    """The optional parts, such as a coat, that any of the finishes has."""
    return tuple(dict.fromkeys(layer for finish in found for layer in finish.layers))


def parts(planning, p):
    model, found = model_in(planning, p), planning.find(finishes)
    if not model.has_finish or not found:
        return
    drawn = {"inputs": ("materials",), "constants": planning.find(material_texels).constants}
    differ, layers = bool(summed_finishes(planning, model)), _layers(found)
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
