# SPDX-License-Identifier: GPL-3.0-or-later
"""Which passes draw splats, and what they are tested with: a part of a plan."""

from __future__ import annotations

from .camera import Camera
from .frame_plan import PlannedPass
from .identity import NUMBERED
from .methods import Method
from .scene import Scene
from .settings import Settings


def splat_passes(
    scene: Scene,
    camera: Camera,
    settings: Settings,
    method: Method,
    has_rows: bool,
    why_depth: str,
    sums: tuple[str, ...],
    left_out: list,
):
    """Visibility and sums, and between them what a method that works in the picture tests its depths with.

    has_rows: visibility has more rows than there are of samples; what transparent layers hide is known at these alone.
    """
    why = _why_attributes(scene, method)
    identity, why_identity = _identity(settings, left_out)
    if method.works_in == "sprites":
        left_out.append(("visibility", f"of {method.name} the nearest splat wins, and nothing blends"))
        writes = *sums, *identity, "seen_depth"
        return (PlannedPass("attributes", f"the nearest splat wins{why_identity}", (), writes),)
    why_visibility = f"splats may hide one another; {why_depth}{why_identity}"
    seen, kept, holes = ("visibility_depth", *identity), ("seen_range",), ()
    if has_rows:
        seen, kept = ("row_depth", *(f"row_{name}" for name in identity)), ("seen_range", *identity, "visibility_depth")
    visibility = PlannedPass("visibility", why_visibility, (), seen)
    if method.works_in == "space":
        left_out.append(("seen_range", f"{method.name} is tested by the hardware, with the depth of visibility"))
        return visibility, PlannedPass("attributes", why, ("visibility_depth",), sums)
    compared = f"{method.name} computes its depths, which are compared in the shader"
    if has_rows:
        compared += "; between samples, silhouettes are looked for alone"
    else:
        seen = seen[:1]
    if any(instance.is_holdout for instance in scene.shown):
        hole = "row_holdout_depth" if has_rows else "holdout_depth"
        holes = (PlannedPass("holdouts", "a filter brings what lies behind a hole before it", (), (hole,)),)
        seen = (*seen, hole)
    culling = _culling_passes(scene, camera, method, left_out)
    return (
        visibility,
        *holes,
        PlannedPass("seen_range", compared, seen, kept),
        *culling,
        PlannedPass("attributes", why, ("seen_range", *(p.writes[0] for p in culling), "visibility_depth"), sums),
    )


def rim_passes(settings: Settings, method: Method) -> tuple[PlannedPass, ...]:
    """What finds whose a sample is that sees only what a filter spreads; where silhouettes are filtered, none does."""
    if method.works_in != "picture" or method.filters_silhouettes or not set(NUMBERED) & set(settings.outputs):
        return ()
    why = f"{method.name} spreads splats past what is visible, which is somebody's"
    return (PlannedPass("rims", why, ("visibility_depth",), ("identity", "rim_depth")),)


def _culling_passes(scene: Scene, camera: Camera, method: Method, left_out: list) -> tuple[PlannedPass, ...]:
    """What tells of splats that they are hidden, where it pays."""
    if not method.culls_hidden:
        left_out.append(("coarse_depth", f"{method.name} draws hidden splats too, as its paper does"))
        return ()
    opaque = [instance for instance in scene.surfels if len(instance.surfels) and not instance.is_transparent]
    showing = sum(instance.shows_backs(camera) for instance in opaque)
    if not showing:
        left_out.append(("coarse_depth", "nothing opaque shows its backs, which most of what is hidden would be"))
        return ()
    why = f"{showing} of {len(opaque)} instances show backs: those behind all that is seen are not drawn"
    return (PlannedPass("coarse_depth", why, ("seen_range",), ("coarse_depth",)),)


def _why_attributes(scene: Scene, method: Method) -> str:
    if not any(len(instance.surfels) for instance in scene.surfels):
        return "there are no splats: their sums stay empty"
    textured = sum(instance.is_textured for instance in scene.surfels)
    looked_up = f"; {textured} of {len(scene.surfels)} instances look textures up" if textured else ""
    return f"overlapping splats blend by {method.name}{looked_up}"


def _identity(settings: Settings, left_out: list) -> tuple[tuple[str, ...], str]:
    """Whether the pass that finds what is nearest says whose it is, and why."""
    asked_for = [name for name in NUMBERED if name in settings.outputs]
    if not asked_for:
        left_out.append(("identity", "no index or matte tells objects or materials apart"))
        return (), ""
    if settings.multisampling:
        raise ValueError(
            f"Hardware samples are not told apart by object: leave {', '.join(asked_for)} out of the outputs, or set "
            "multisampling to 0 and use supersampling."
        )
    return ("identity",), f"; {', '.join(asked_for)} tell whose it is"
