# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame needs, decided before anything is allocated: a pure function from scene, camera and settings.

Nothing exists on the device that the plan does not name, each entry has its reason, and what was left out has one too:
print the plan to read them.
"""

from __future__ import annotations

import math
from dataclasses import replace

from ..scene import Scene
from ..scene.camera import Camera
from ..settings import Settings
from ..upload.storages import get_storage
from .frame_plan import FILTER_MARGIN, VISIBILITY_ROWS, FramePlan
from .graph import Pass, changed, trimmed
from .planning import Planning

#: A target's edge in samples; a larger picture is rendered in tiles, so that memory stays below about 1 GB.
MAX_TARGET_EDGE = 4096


def plan(
    scene: Scene,
    camera: Camera,
    settings: Settings,
    shadow_camera: Camera | None = None,
    is_added_up: bool = False,
    part: tuple[int, int, int, int] | None = None,
) -> FramePlan:
    """The passes that this picture needs.

    shadow_camera: to whose view shadow maps are fitted, if it is another, so that cameras which differ little share
    them. is_added_up: the picture is one of the samples of a view that refines. part: x, y, width, height in pixels, of
    a picture that is not drawn whole. Raises ValueError for an unknown method
    or storage, for multisampling with a method that does not work in space, and for a picture that devices have no room
    for.
    """
    from ..features import FEATURES, accumulation, depth_format, object_id, outputs

    planning = Planning(scene, camera, settings, shadow_camera or camera, is_added_up)
    if settings.multisampling and planning.method.works_in != "space":
        raise ValueError(
            f"Method {planning.method.name} works in the picture, where hardware multisampling sees nothing; set "
            "multisampling to 0 and use supersampling, or method quad."
        )
    storage = get_storage(settings.storage).name
    found = [p for f in FEATURES if hasattr(f, "passes") for p in f.passes(planning)]
    if [p.name for p in found] == ["accumulate"]:
        found = []
    live = (*outputs.live(planning), *object_id.read_back(planning), *((accumulation.SUM,) if is_added_up else ()))
    steps, _ = trimmed(changed(found, lambda p: _with_parts(planning, p, FEATURES)), live)
    planning.facts["filters_silhouettes"] = planning.method.filters_silhouettes and bool(planning.shown)
    is_linear = planning.find(depth_format.linear)[0]
    each = settings.multisampling and not settings.sample_shading
    made = FramePlan(
        tiles=_tiles(part or (0, 0, *camera.size), tile_edge(planning)),
        samples=settings.supersampling,
        multisamples=settings.multisampling,
        sample_shading=bool(settings.multisampling and settings.sample_shading),
        method=settings.method,
        storage=storage,
        accumulation=settings.accumulation,
        linear_depth=is_linear,
        steps=steps,
        variants=frozenset(["linear"] if is_linear else []),
        choices=(
            ("method", settings.method),
            ("storage", storage),
            ("shading", settings.shading),
            ("sum_format", settings.accumulation),
            ("samples", "mean" if each else "each"),
        ),
        margin=_margin(planning),
        sizes=SIZES,
        facts=planning.facts,
        features=tuple(planning.features),
        skipped=tuple(planning.skipped),
    )
    outputs.check(made)
    return made


def _with_parts(planning: Planning, p: Pass, features) -> Pass:
    """A pass with what all features do in it."""
    if not p.host:
        return p
    parts = [part for f in features if hasattr(f, "parts") for part in f.parts(planning, p)]
    reason = "; ".join([p.reason, *(part.reason for part in parts if part.reason)])
    return replace(p, reason=reason, parts=(*p.parts, *parts))


def _margin(planning: Planning) -> int:
    """Pixels drawn around a tile and not kept: what features look at beside it."""
    from ..features import FEATURES, transparency

    filtered = FILTER_MARGIN if planning.facts["filters_silhouettes"] else 0
    layered = transparency.LAYER_MARGIN if planning.facts.get("layers") else 0
    return filtered + layered + sum(f.margin(planning) for f in FEATURES if hasattr(f, "margin"))


def _of_picture(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    return max(x + width for x, _, width, _ in plan.tiles), max(y + height for _, y, _, height in plan.tiles)


def _of_cells(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    from ..features.hiz import CELL

    width, height = (-(-edge * plan.samples // CELL) for edge in pixels)
    return width, height


def _of_rows(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    return pixels[0] * plan.samples, pixels[1] * plan.samples * VISIBILITY_ROWS


def _of_blocks(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    from ..features.transparency import BLOCKS

    return BLOCKS, BLOCKS


def _of_splats(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    from ..upload.packing import SPLATS_PER_ROW

    return SPLATS_PER_ROW, plan.facts["lit_rows"]


def _of_frame(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    from ..shadow import atlas_size

    return atlas_size(plan.facts["shadow_maps"])


#: what a texture holds one value for -> its size, for a tile of so many pixels with its margin
SIZES = {
    "pixel": lambda plan, pixels: pixels,
    "sample": lambda plan, pixels: (pixels[0] * plan.samples, pixels[1] * plan.samples),
    "row": _of_rows,
    "cell": _of_cells,
    "block": _of_blocks,
    "splat": _of_splats,
    "picture": _of_picture,
    "frame": _of_frame,
}


def tile_edge(planning: Planning) -> int:
    """In pixels: along it lie the samples, and the square root of the hardware's samples in each. To filter silhouettes
    takes half as many textures again.
    """
    settings = planning.settings
    room = 2 if planning.method.filters_silhouettes else 1
    across = settings.supersampling * room * math.ceil(math.sqrt(max(settings.multisampling, 1)))
    return max(MAX_TARGET_EDGE // across, 1)


def _tiles(part: tuple[int, int, int, int], edge: int) -> tuple[tuple[int, int, int, int], ...]:
    left, bottom, width, height = part
    return tuple(
        (left + x, bottom + y, min(edge, width - x), min(edge, height - y))
        for y in range(0, height, edge)
        for x in range(0, width, edge)
    )
