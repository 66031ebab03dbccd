# SPDX-License-Identifier: GPL-3.0-or-later
"""What a plan is: the passes of a frame with their reasons, and the textures that they write."""

from __future__ import annotations

from dataclasses import dataclass

from .packing import SPLATS_PER_ROW
from .scene import Material
from .shadow import ShadowMap, atlas_size

#: Samples that shaders/resolve.frag.glsl reads to each side; shaders/common/silhouette_filter.glsl has the same.
FILTER_MARGIN = 2

#: And what shaders/common/layer_at.glsl and shaders/rest_shading.frag.glsl read beside that.
LAYER_MARGIN = 1

#: Rows of visibility to each row of samples, where silhouettes are filtered; the first of them goes through the centres
#: of the samples. shaders/common/silhouette_filter.glsl has the same.
VISIBILITY_ROWS = 2

#: Samples along each side of what "coarse_depth" holds one value for; shaders/common/cells.glsl has the same.
CELL = 4

#: texture -> (format, what it holds one value for)
TEXTURES = {
    "row_depth": ("DEPTH32F", "row"),
    "row_identity": ("RG32F", "row"),
    "visibility_depth": ("DEPTH32F", "sample"),
    "identity": ("RG32F", "sample"),
    "identity_next": ("RG32F", "sample"),
    "layer_identity": ("RG32F", "sample"),
    "polygon_identity": ("RG32F", "sample"),
    "rim_depth": ("DEPTH32F", "sample"),
    "holdout_depth": ("DEPTH32F", "sample"),
    "row_holdout_depth": ("DEPTH32F", "row"),
    "seen_range": ("RGBA32F", "sample"),
    "coarse_depth": ("R32F", "cell"),
    "seen_depth": ("DEPTH32F", "sample"),
    "color_sum": ("RGBA32F", "sample"),
    "normal_sum": ("RGBA32F", "sample"),
    "depth_sum": ("RG32F", "sample"),
    "material_sum": ("RGBA32F", "sample"),
    "emission_sum": ("RGBA32F", "sample"),
    "light_set_sum": ("RGBA32F", "sample"),
    "overdraw_sum": ("R32F", "sample"),
    "polygon_color": ("RGBA32F", "sample"),
    "polygon_normal": ("RGBA32F", "sample"),
    "polygon_material": ("RGBA32F", "sample"),
    "polygon_emission": ("RGBA32F", "sample"),
    "polygon_plane": ("RGBA32F", "sample"),
    "polygon_depth": ("DEPTH32F", "sample"),
    "lines": ("R32F", "sample"),
    "layer_depth": ("DEPTH32F", "sample"),
    "left": ("R32F", "block"),
    "peeled": ("RG32F", "sample"),
    "peeled_next": ("RG32F", "sample"),
    "lit_splats": ("RGBA32F", "splat"),
    "rest_sum": ("RGBA32F", "sample"),
    "rest_weight": ("RG32F", "sample"),
    "layers": ("RGBA32F", "pixel"),
    "layers_depth": ("R32F", "pixel"),
    "layers_normal": ("RGBA32F", "pixel"),
    "layers_diffuse_color": ("RGBA32F", "pixel"),
    "layers_emission": ("RGBA32F", "pixel"),
    "layers_shadow_overdraw": ("RGBA32F", "pixel"),
    "shaded": ("RGBA32F", "sample"),
    "surface": ("RGBA32F", "sample"),
    "sample_diffuse_color": ("RGBA32F", "sample"),
    "sample_emission": ("RGBA32F", "sample"),
    "sample_shadow_overdraw": ("RGBA32F", "sample"),
    "shadow_depth": ("DEPTH32F", "frame"),
    "sample_sum": ("RGBA32F", "picture"),
    "combined": ("RGBA32F", "pixel"),
    "depth": ("R32F", "pixel"),
    "normal_coverage": ("RGBA32F", "pixel"),
    "diffuse_color": ("RGBA32F", "pixel"),
    "emission": ("RGBA32F", "pixel"),
    "shadow_overdraw": ("RGBA32F", "pixel"),
}

#: array of a `Frame` -> the texture of the last pass that holds it, and where in its last axis
HELD_BY = {
    "color": ("combined", slice(0, 4)),
    "depth": ("depth", 0),
    "normal": ("normal_coverage", slice(0, 3)),
    "coverage": ("normal_coverage", 3),
    "diffuse_color": ("diffuse_color", slice(0, 3)),
    "emission": ("emission", slice(0, 3)),
    "shadow": ("shadow_overdraw", slice(0, 3)),
    "overdraw": ("shadow_overdraw", 3),
}

#: accumulation -> texture -> format, where it is not the one above; emission has no bound that a half could hold.
SUM_FORMATS = {
    "float32": {},
    "float16": {"color_sum": "RGBA16F", "normal_sum": "RGBA16F", "material_sum": "RGBA16F", "light_set_sum": "RGBA16F"},
}


#: Of a picture along each side, for which "left" holds one value each.
BLOCKS = 64

#: Those that draw splats and polygons.
SPLAT_PASSES = ("visibility", "polygons", "attributes")


@dataclass(frozen=True)
class PlannedPass:
    """name: also of its pipeline. reason: why the frame needs it.
    reads, writes: names of textures in slot order; "lights" holds the scene's.
    is_shared: made with the first tile, for all.
    layer: number of the transparent layer that it makes, from the nearest, 1; 0 where it makes none.
    """

    name: str
    reason: str
    reads: tuple[str, ...]
    writes: tuple[str, ...]
    is_shared: bool = False
    layer: int = 0


@dataclass(frozen=True)
class FramePlan:
    """tiles: (x, y, width, height) in pixels, each rendered with all passes and, where silhouettes are filtered, with a
        margin that the filter reads.
    samples: N of the N x N samples a pixel.
    material, emission: the one that all surfels share, or None.
    multisamples: M hardware samples of each of them, or 0. sample_shading: they are evaluated and lit one by one.
    storage, accumulation: as in the settings.
    linear_depth: fragments write depth / far, because the hardware's depth would be too coarse.
    features: (name, why), of what shaders do beside the least; each name is defined in their text.
    shadow_maps: what lights see, in the order of the lights.
    depth_range: nearest and farthest of what is in view, world units.
    lit_rows: of the texture that holds the light of an instance's splats.
    line_margin: pixels that lines look at beside their own.
    left_out: (what, why), of what other scenes or settings would need.
    """

    tiles: tuple[tuple[int, int, int, int], ...]
    samples: int
    method: str
    shading: str
    multisamples: int
    sample_shading: bool
    storage: str
    accumulation: str
    material: Material | None
    emission: tuple[float, float, float] | None
    linear_depth: bool
    passes: tuple[PlannedPass, ...]
    features: tuple[tuple[str, str], ...]
    shadow_maps: tuple[ShadowMap, ...]
    depth_range: tuple[float, float]
    lit_rows: int
    line_margin: int
    left_out: tuple[tuple[str, str], ...]

    def has(self, feature: str) -> bool:
        """Whether shaders do this."""
        return feature in (name for name, _ in self.features)

    @property
    def layers(self) -> int:
        """How many transparent layers are peeled at most."""
        return max((p.layer for p in self.passes), default=0)

    @property
    def margin(self) -> int:
        """Pixels drawn around a tile and not kept."""
        filtered = FILTER_MARGIN if self.filters_silhouettes else 0
        return filtered + (LAYER_MARGIN if self.layers else 0) + self.line_margin

    @property
    def filters_silhouettes(self) -> bool:
        """Whether a resolve pass does."""
        return any(p.name == "resolve" for p in self.passes)

    @property
    def numbers(self) -> tuple[str, int]:
        """The texture of whose the samples are that mattes are made of, and its rows to a row of samples."""
        return ("row_identity", VISIBILITY_ROWS) if "row_identity" in self.textures else ("identity", 1)

    def size(self, texture: str, pixels: tuple[int, int]) -> tuple[int, int]:
        """Width and height of a texture, for a tile of so many pixels; the frame's are common to all tiles."""
        what_for = TEXTURES[texture][1]
        if what_for == "frame":
            return atlas_size(self.shadow_maps)
        if what_for == "picture":
            return max(x + width for x, _, width, _ in self.tiles), max(y + height for _, y, _, height in self.tiles)
        if what_for == "splat":
            return SPLATS_PER_ROW, self.lit_rows
        if what_for == "block":
            return BLOCKS, BLOCKS
        along = 1 if what_for == "pixel" else self.samples
        if what_for == "cell":
            width, height = (-(-edge * along // CELL) for edge in pixels)
            return width, height
        return pixels[0] * along, pixels[1] * along * (VISIBILITY_ROWS if what_for == "row" else 1)

    def format(self, texture: str) -> str:
        """A name in `device.interface.FORMATS`."""
        return SUM_FORMATS[self.accumulation].get(texture, TEXTURES[texture][0])

    def multisamples_of(self, texture: str) -> int:
        """Samples a texel, 0 for one: what splats are drawn into has them."""
        drawn = {name for p in self.passes if p.name in SPLAT_PASSES for name in p.writes}
        return self.multisamples if texture in drawn else 0

    @property
    def textures(self) -> tuple[str, ...]:
        """Names of every texture that some pass writes, once each."""
        return tuple(dict.fromkeys(name for p in self.passes for name in p.writes))

    def __str__(self) -> str:
        depth = "linear" if self.linear_depth else "hardware"
        lines = [
            f"{len(self.tiles)} tile(s), {self.samples} x {self.samples} samples, method {self.method}, {depth} depth, "
            f"{self.storage} splats, {self.accumulation} sums"
        ]
        if self.multisamples:
            each = "evaluated and lit one by one" if self.sample_shading else "evaluated once, lit once for their mean"
            lines.append(f"  with {self.multisamples} hardware samples in each: {each}")
        for p in self.passes:
            layer = f" of layer {p.layer}" if p.layer else ""
            lines.append(
                f"  {p.name}{layer}: {', '.join(p.writes)} <- {', '.join(p.reads) or 'what is placed'}; {p.reason}"
            )
        lines += [f"  with {name}: {why}" for name, why in self.features]
        lines += [f"  without {what}: {why}" for what, why in self.left_out]
        return "\n".join(lines)
