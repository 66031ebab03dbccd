# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans a frame before anything is allocated: a pure function of scene, camera and settings.

Nothing exists on the device that the plan does not name. Each entry has its reason, and so does everything that was
left out: print the plan to read them.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable

from ..detail.history import History, no_history
from ..features import CHECKS, MARGINS, PARTS, PASSES, READ_BACK
from ..passes.decisions import depth_format
from ..probes.places import Probe
from ..scene import Scene
from ..scene.camera import Camera
from ..settings import Settings
from ..shading_models import get_shading_model
from ..shadows.receivers import Viewers
from ..upload.storages import get_storage
from .frame_plan import FramePlan
from .graph import Part, Pass, Step, changed, trimmed
from .planning import Planning
from .tiles import tile_edge, tiles


def plan(
    scene: Scene,
    camera: Camera,
    settings: Settings,
    viewers: Viewers | None = None,
    is_added_up: bool = False,
    part: tuple[int, int, int, int] | None = None,
    samples: int | None = None,
    history: History | None = None,
    around: Camera | None = None,
    probes: tuple[Probe, ...] = (),
) -> FramePlan:
    """The passes that this picture needs.

    viewers: the cameras that shadow maps serve, if there are others, so that similar cameras can share maps.
    is_added_up: whether the picture is one sample of a refining view.
    part: x, y, width, height in pixels, if only a part of the picture is drawn.
    samples: number of samples that show this scene, if fewer than the picture's.
    history: what earlier pictures have left behind; None for a picture that is the same whatever was drawn before it.
    around: a camera that sees all that the cameras of several samples see, if the plan is for all of them.
    probes: those that are drawn, if the picture is of what is reflected: glossy objects in it show what these saw.
    """
    planning = Planning(
        scene,
        camera,
        settings,
        viewers=viewers or Viewers(camera, (camera,)),
        is_added_up=is_added_up,
        samples=samples or settings.samples,
        history=history or no_history(scene),
        around=around or camera,
        part=part or (0, 0, *camera.size),
        probes=probes,
    )
    _check_multisampling(planning)
    steps = _steps(planning)
    is_linear = planning.find(depth_format).is_linear
    made = FramePlan(
        tiles=tiles(planning.part, tile_edge(planning)),
        samples=settings.supersampling,
        multisamples=settings.multisampling,
        sample_shading=bool(settings.multisampling and settings.sample_shading),
        # the box that several samples add to a pixel is wider than the Gaussian of more than 2 x 2 of its own
        filter_variance=settings.gaussian_variance - (camera.sample_variance if settings.supersampling == 1 else 0.0),
        method=settings.method,
        storage=get_storage(settings.storage).name,
        sum_format=settings.sum_format,
        linear_depth=is_linear,
        steps=steps,
        variants=frozenset(["linear"] if is_linear else []),
        choices=_choices(settings),
        margin=sum(margin(planning) for margin in MARGINS),
        found=planning.found,
        features=tuple(planning.features),
        skipped=tuple(planning.skipped),
        limits=tuple(planning.limits),
    )
    for check in CHECKS:
        check(made)
    return made


def _steps(planning: Planning) -> tuple[Step, ...]:
    """The passes and loops whose results are read, with the parts of all features that are present."""
    found = [p for passes in PASSES for p in passes(planning)]
    present = [parts for parts, is_present in PARTS if is_present(planning)]
    live = {texture for read_back in READ_BACK for texture in read_back(planning)}
    steps, _ = trimmed(changed(found, lambda p: _with_parts(planning, p, present)), live)
    return steps


def _check_multisampling(planning: Planning) -> None:
    if planning.settings.multisampling and planning.method.rasterizer != "object_space":
        raise ValueError(
            f"Method {planning.method.name} filters in screen space, where hardware multisampling has no effect; set "
            "multisampling to 0 and use supersampling, or method quad."
        )


def _choices(settings: Settings) -> tuple[tuple[str, str], ...]:
    """Which file each name in the paths of shaders stands for."""
    world_light = get_shading_model(settings.shading).world_light
    has_mean = settings.multisampling and not settings.sample_shading
    return (
        ("method", settings.method),
        ("storage", get_storage(settings.storage).name),
        ("shading", settings.shading),
        ("sum_format", settings.sum_format),
        *((("world_light", world_light),) if world_light else ()),
        ("samples", "mean" if has_mean else "each"),
        ("sides", "alike" if settings.as_printed else "told_apart"),
        ("rest_opacity", "printed" if settings.as_printed else "surfaces"),
    )


def _with_parts(planning: Planning, p: Pass, present: Iterable[Callable[[Planning, Pass], Iterable[Part]]]) -> Pass:
    """A pass with the parts of all features that are present."""
    if p.host is None:
        return p
    found = [part for parts in present for part in parts(planning, p)]
    reason = "; ".join([p.reason, *(part.reason for part in found if part.reason)])
    return p.with_values(reason=reason, parts=(*p.parts, *found))
