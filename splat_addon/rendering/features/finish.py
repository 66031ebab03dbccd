# SPDX-License-Identifier: GPL-3.0-or-later
"""What surfaces have beside roughness, metallic and reflectance (`scene.finish`): few finishes, many surfels.

A table holds the frame's finishes. If there are several, each sample sums the shares of all but the first, and the rows
of the table are mixed by them.
"""

from __future__ import annotations

from collections import Counter

from ..plan.graph import Part, Texture
from ..scene import Finish
from ..upload.brdf_table import edge_texels
from ..upload.packing import MAX_FINISHES, pack_finishes
from . import materials
from .drawing import LIGHTING_HOSTS, LIT_HOSTS, SPLAT_HOSTS

SHARES = Texture("gbuffer_finish", is_multisampled=True, is_sum=True)


def _uploaded(tile):
    return tile.resources.data(pack_finishes(tile.plan.facts["finishes"]))


INPUTS = {"finishes": _uploaded, "edge_table": lambda tile: tile.resources.constant(edge_texels)}
#: part of a finish -> the table that its shading looks up
_TABLES = {"specular_tint": "edge_table"}


def found(planning) -> tuple[Finish, ...]:
    """The finishes that the frame tells apart, the most common first; none if all are plain."""
    counted = Counter(material.finish for placed in planning.shown for material in placed.materials)
    kept = tuple(finish for finish, _ in counted.most_common(MAX_FINISHES))
    return kept if any(finish.layers for finish in kept) else ()


def summed(planning) -> tuple[Finish, ...]:
    """The finishes if there are several, because each sample then sums their shares; otherwise none."""
    kept = planning.find(found) if planning.model.has_finish else ()
    return kept if len(kept) > 1 else ()


def passes(planning):
    """No passes; records what the frame has."""
    planning.facts["finishes"] = kept = planning.find(found)
    planning.facts["summed_finishes"] = summed(planning)
    if not kept:
        planning.skip("finish", "all materials are plain")
        return ()
    if not planning.model.has_finish:
        planning.skip("finish", f"{planning.model.name} shading does not look at it")
        return ()
    planning.has("FINISH", f"{len(kept)} of {', '.join(_layers(kept))}")
    every = {material.finish for placed in planning.shown for material in placed.materials}
    if len(every) > len(kept):
        planning.skip("finishes", _TOO_MANY.format(len(every), len(kept)))
    return ()


_TOO_MANY = (
    "materials have {} different combinations of Coat, Sheen and Specular Tint, and a picture shows {}; the others "
    "look like the most similar of these"
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
    if p.host in SPLAT_HOSTS and p.kind in ("opaque", "layer") and differ:
        yield Part("finish", writes=(SHARES,), varyings=(("flat", "vec4", "finish"),), **drawn)
    if p.host in LIGHTING_HOSTS:
        tables = (_TABLES[layer] for layer in layers if layer in _TABLES)
        covered = () if _COVERS.isdisjoint(layers) else ("covered",)
        yield Part("finish", (*layers, *covered), inputs=("finishes", *tables))
    if p.host in LIT_HOSTS and differ:
        yield Part("finish", ("finishes_differ",), reads=(SHARES,))
    if p.host == "lit_splats.frag" and differ:
        yield Part("finish", ("finishes_differ",), **drawn)
