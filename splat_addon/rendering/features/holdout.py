# SPDX-License-Identifier: GPL-3.0-or-later
"""Objects that cut holes: they have depth and nothing else."""

from __future__ import annotations

from dataclasses import replace

from ..passes.decisions import nearest_depth
from ..passes.textures import VISIBILITY_DEPTH, of_rows
from ..plan.graph import Part, Pass, Texture
from ..plan.hosts import LIT_HOSTS, SPLAT_HOSTS, Host, Kind
from ..plan.planning import count
from . import visibility

DEPTH = Texture("holdout_depth", "DEPTH32F")
ROW_DEPTH = Texture("row_holdout_depth", "DEPTH32F", of_rows)


def _count(planning) -> int:
    """Number of holdouts; 0 for methods in which the nearest splat wins, because their only depth is that splat's."""
    if planning.method.rasterizer == "point_sprite":
        return 0
    return count(lambda instance: instance.is_holdout, planning.scene.table.kinds)


def passes(planning):
    cutting = count(lambda instance: instance.is_holdout, planning.scene.table.kinds)
    if cutting and not _count(planning):
        planning.lack("holdout", f"{planning.method.name} draws objects that cut holes as others")
    elif cutting:
        planning.has("HOLDOUT", f"{cutting} of {len(planning.shown)} instances cut holes")
    if cutting and planning.method.rasterizer == "screen_space":
        own = visibility.own_parts(planning, nearest_depth(planning, DEPTH, ROW_DEPTH))
        why = "a filter brings what lies behind a hole before it"
        yield visibility.drawn("holdouts", why, own, planning, Kind.HOLES).with_values(run=run)


def is_present(planning) -> bool:
    return bool(planning.find(_count))


def parts(planning, p):
    if p.kind != Kind.OPAQUE:
        return
    if p.host == Host.DEPTH_BOUNDS:
        depth = nearest_depth(planning, DEPTH, ROW_DEPTH)
        yield Part("holdout", reads=(depth,), called=((depth, "holes"),))
    if p.host in LIT_HOSTS:
        yield Part("holdout", reads=(VISIBILITY_DEPTH,))
    if p.host in (Host.SCREEN_SPACE, Host.RESOLVE):
        yield Part("holdout")


def draws(tile, p: Pass, instance) -> bool:
    """Whether a pass draws an object: holdouts have depth only."""
    return not (instance.is_holdout and p.kind == Kind.OPAQUE and p.host in SPLAT_HOSTS and tile.plan.has("HOLDOUT"))


def run(tile, p):
    """Fill the depth texture: where a hole is visible, with exactly the depth of the visibility pass."""
    kinds = {name: getattr(tile.view, name) for name in ("placed", "polygons")}
    cutting = {name: items.of_kinds(lambda i: i.is_holdout) for name, items in kinds.items()}
    return visibility.run(replace(tile, view=replace(tile.view, **cutting)), p)
