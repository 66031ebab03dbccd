# SPDX-License-Identifier: GPL-3.0-or-later
"""The textures that several features write or read. Those of a single one are in its module."""

from __future__ import annotations

from ..frame import HELD_BY
from ..plan.frame_plan import VISIBILITY_ROWS, FramePlan
from ..plan.graph import Texture, of_pixels, of_samples


def of_rows(plan: FramePlan, pixels: tuple[int, int]) -> tuple[int, int]:
    """A texture size: `VISIBILITY_ROWS` rows per row of samples."""
    columns, rows = of_samples(plan, pixels)
    return columns, rows * VISIBILITY_ROWS


def rows_of(texture: Texture) -> int:
    """Number of the texture's rows per row of samples."""
    return VISIBILITY_ROWS if texture.per is of_rows else 1


#: Depths of what is nearest, moved back by what blends; and where there are more rows than samples.
VISIBILITY_DEPTH = Texture("visibility_depth", "DEPTH32F", is_multisampled=True)
ROW_DEPTH = Texture("row_depth", "DEPTH32F", of_rows)
#: The range of visible depths of each sample.
DEPTH_BOUNDS = Texture("depth_bounds")
#: The number of the object that is nearest.
IDENTITY = Texture("identity", "RG32F")
ROW_IDENTITY = Texture("row_identity", "RG32F", of_rows)
POLYGON_IDENTITY = Texture("polygon_identity", "RG32F")

#: Sums of splats' weighted attributes.
COLOR_SUM = Texture("gbuffer_color", is_multisampled=True, is_sum=True)
NORMAL_SUM = Texture("gbuffer_normal", is_multisampled=True, is_sum=True)
DEPTH_SUM = Texture("gbuffer_depth", "RG32F", is_multisampled=True)
#: With room for the planes that shadows compare depths with, because targets have no room for another texture.
DEPTH_PLANE_SUM = Texture("gbuffer_depth", "RGBA32F", is_multisampled=True)
#: Sum of the splats' geometric normals: shadows compare depths with their plane.
PLANE_SUM = Texture("gbuffer_plane", "RG32F", is_multisampled=True)
#: With room for the number of splats and for lifts, because targets have no room for another texture.
PLANE_MORE_SUM = Texture("gbuffer_plane", "RGBA32F", is_multisampled=True)

#: The depth of each sample, for features that read many of them.
SAMPLE_DEPTHS = Texture("sample_depths", "R32F")

#: Lit samples, and what a filter tells surfaces apart by.
SHADED = Texture("shaded")
SURFACE = Texture("surface")

#: The pixels of a frame, by the names of what they hold.
PIXELS = {
    name: Texture(name, "R32F" if name == "depth" else "RGBA32F", of_pixels)
    for name in dict.fromkeys(texture for texture, _ in HELD_BY.values())
}
#: Those that the last pass always writes.
ALWAYS_WRITTEN = PIXELS["combined"], PIXELS["depth"]
#: Those for outputs of lit samples; the feature of the same name fills each.
HANDED_ON = tuple(name for name in PIXELS if name not in ("combined", "depth", "normal_coverage"))
#: What such outputs are handed on by: samples whose silhouettes are filtered later, and transparent layers.
SAMPLES = {name: Texture(f"sample_{name}") for name in HANDED_ON}
LAYERS = {name: Texture(f"layers_{name}", per=of_pixels) for name in HANDED_ON}
LAYERS_NORMAL = Texture("layers_normal", per=of_pixels)
#: Functions know an output by one name, whichever texture it is written to.
CALLED = tuple((kind[name], f"out_{name}") for kind in (PIXELS, SAMPLES, LAYERS) for name in HANDED_ON)

#: Maximum number of colour textures in a target, Blender's limit.
MAX_COLORS = 6
