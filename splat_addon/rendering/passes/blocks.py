# SPDX-License-Identifier: GPL-3.0-or-later
"""Uniform blocks: their layout as GLSL sees it, and their values as a device takes them."""

from __future__ import annotations

import numpy as np

from ..frame_plan import FramePlan, PlannedPass


def std140(*parts) -> np.ndarray:
    """float32 values: matrices column by column, vectors of four."""
    return np.concatenate([np.asarray(p, np.float64).T.ravel() for p in parts]).astype(np.float32)


#: Defined where fragments write depth / far.
LINEAR_DEPTH = (("LINEAR_DEPTH", "1"),)


def material_defines(names: tuple[str, ...]) -> tuple[tuple[str, str], ...]:
    """What is defined where these textures, of a pass, hold sums over the splats' own materials."""
    targets = [(f"{name.upper()}_TARGET", "1") for name in ("material", "emission") if f"{name}_sum" in names]
    return (*targets, ("WITH_MATERIALS", "1")) if targets else ()


def says_whose(planned: PlannedPass) -> bool:
    """Whether a pass that draws splats leaves their numbers."""
    return bool({"identity", "row_identity", "layer_identity", "polygon_identity"} & set(planned.writes))


def split_defines(frame: FramePlan) -> tuple[tuple[str, str], ...]:
    """What is defined where something is drawn of objects that may be split by distance."""
    return (("SPLIT", "1"),) if frame.has("SPLIT") else ()


def split_polygons(frame: FramePlan) -> tuple[tuple, tuple]:
    """Varyings and defines that polygons have beside, where they may end at a distance."""
    if not frame.has("SPLIT"):
        return (), ()
    return (("smooth", "vec3", "split_place"),), (("SPLIT", "1"), ("SPLIT_POLYGONS", "1"))


def identity_defines(planned: PlannedPass) -> tuple[tuple[str, str], ...]:
    """What is defined where a pass says whose the splats are that it sees."""
    return (("IDENTITY_TARGET", "1"),) if says_whose(planned) else ()


def identity_varyings(planned: PlannedPass) -> tuple[tuple[str, str, str], ...]:
    """What its fragments are told for that."""
    return (("flat", "float", "number"),) if says_whose(planned) else ()


def sum_defines(names: tuple[str, ...], accumulation: str) -> tuple[tuple[str, str], ...]:
    """What is defined where a pass reads or writes these sums: depths may be apart, and numbers smaller."""
    is_half = accumulation == "float16"
    return (*((("DEPTH_SUM", "1"),) if "depth_sum" in names else ()), *((("HALF_SUMS", "1"),) if is_half else ()))


def polygon_defines(planned: PlannedPass, frame: FramePlan) -> tuple[tuple[str, str], ...]:
    """What is defined for a pass that joins polygons with splats, and where the former are known to be seen."""
    if "polygon_color" not in planned.reads:
        return ()
    return (("POLYGONS", "1"), *((("SEEN_POLYGONS", "1"),) if "seen_range" in frame.textures else ()))


#: Defined where a resolve pass filters silhouettes.
FILTERS_SILHOUETTES = (("FILTERS_SILHOUETTES", "1"),)

#: Defined where silhouettes are looked for in more rows of visibility than there are of samples.
HAS_ROWS = (("HAS_ROWS", "1"),)

#: Defined where a transparent layer is made.
LAYER = (("LAYER", "1"),)

#: Defined where it is known which samples see a hole.
HOLDOUT = (("HOLDOUT", "1"),)
