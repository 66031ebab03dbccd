# SPDX-License-Identifier: GPL-3.0-or-later
"""The graphics interface that the renderer uses: four nouns, no hidden state.

*Device* makes the other three. *Texture*: pixels on the device. *Target*: textures to draw into. *Pipeline*: a
program with its complete state, so that draws do not affect one another. A pipeline is described once
(`PipelineDescription`); each device declares inputs and outputs in its own way, and the GLSL text of `main` and its
functions is identical on both.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol
from weakref import WeakSet

import numpy as np

#: format -> channels; RGBA16 stores 0 to 1 in multiples of 1 / 65535
FORMATS = {"RGBA32F": 4, "RGBA16F": 4, "RGBA16": 4, "RG32F": 2, "R32F": 1, "DEPTH32F": 1}

#: Texels along an edge of a texture that all tested backends support.
MAX_TEXTURE_EDGE = 16384

#: Programs that a device keeps: about twenty make a picture, but an animated setting may need new ones each frame.
PROGRAMS = 512

#: format -> bytes per channel, if not 4
_CHANNEL_BYTES = {"RGBA16F": 2, "RGBA16": 2}


def texture_bytes(textures: Iterable[Texture]) -> int:
    """The bytes of these textures, without the driver's overhead."""
    return sum(_bytes_of(t.size, t.format, t.samples) for t in textures)


def _bytes_of(size: tuple[int, int], format: str, samples: int) -> int:
    return size[0] * size[1] * FORMATS[format] * _CHANNEL_BYTES.get(format, 4) * max(samples, 1)


def check_texture_size(size: tuple[int, int], largest: int) -> None:
    """Raise ValueError if a texture exceeds `largest`, the device's maximum number of texels along an edge."""
    if max(size) > largest:
        raise ValueError(
            f"A picture of {size[0]:,} x {size[1]:,} pixels does not fit on this graphics device, which holds up to "
            f"{largest:,} along an edge; scale it down."
        )


def check_memory(device: Device, size: tuple[int, int], format: str, samples: int = 0) -> None:
    """Raise ValueError if another such texture would exceed the device's memory limit."""
    if device.most_bytes is None:
        return
    needed = texture_bytes(device.textures) + _bytes_of(size, format, samples)
    if needed > device.most_bytes:
        raise ValueError(
            f"The picture needs more than {device.most_bytes / 1e6:,.0f} MB of the graphics device, the most that the "
            "add-on's preferences let it take; raise that, draw fewer surfels or a smaller picture, or choose 16-bit "
            "as Surfel Storage."
        )


@dataclass(frozen=True)
class PipelineDescription:
    """name: for error messages. vertex, fragment: GLSL without declarations of the inputs and outputs below.
    blocks: (struct name, instance name, ((type, field), ...)) of each uniform block, std140: mat4, vec4, vec2, float.
    samplers: names of 2D float textures, in slot order. multisampled: names of those with several samples per texel.
    varyings: (interpolation "smooth" | "flat", type, name) from vertex to fragment.
    outputs: (type, name) in slot order; empty for depth only.
    defines: (name, value) of constants that the text uses and drivers fold.
    blend: "none" or "add" (all channels summed). depth_test: less or equal. fragment_depth: the fragment shader writes
        gl_FragDepth. sample_shading: on a multisampled target, the fragment shader runs once per sample instead of once
        per pixel.
    """

    name: str
    vertex: str
    fragment: str
    blocks: tuple[tuple[str, str, tuple[tuple[str, str], ...]], ...] = ()
    samplers: tuple[str, ...] = ()
    varyings: tuple[tuple[str, str, str], ...] = ()
    outputs: tuple[tuple[str, str], ...] = ()
    defines: tuple[tuple[str, str], ...] = ()
    blend: str = "none"
    depth_test: bool = False
    depth_write: bool = False
    fragment_depth: bool = False
    multisampled: tuple[str, ...] = ()
    sample_shading: bool = False


class Texture(Protocol):
    """size: width, height. format: a name in `FORMATS`. samples: per texel, 0 for a single-sample texture."""

    size: tuple[int, int]
    format: str
    samples: int


class Target(Protocol):
    """Textures to draw into, all of the same size."""

    size: tuple[int, int]

    def clear(self, color: float | Sequence[float] | None = None, depth: float | None = None) -> None:
        """Fill every colour texture with one value, or one for each of four channels, and the depth texture with
        another."""

    def read(self, slot: int) -> np.ndarray:
        """The pixels of a colour texture: (h, w, channels) float32, row 0 at the bottom."""


class Pipeline(Protocol):
    description: PipelineDescription


class Device(Protocol):
    """A graphics device.

    kind: its name in `DEVICES`. backend: "OpenGL", "Vulkan" ... renderer, version: the driver's own description.
    multisample_counts: supported numbers of samples per texel, besides one. max_samplers: number of textures that a
    shader can read. textures: those that exist. most_bytes: their maximum total size; None for no limit.
    """

    kind: str
    backend: str
    renderer: str
    version: str
    multisample_counts: tuple[int, ...]
    max_samplers: int
    textures: WeakSet[Texture]
    most_bytes: int | None

    def texture(self, size: tuple[int, int], format: str, data: np.ndarray | None = None, samples: int = 0) -> Texture:
        """Create a texture.

        data: (h, w, channels) float32, row 0 first; if it is missing, the contents are undefined. samples: one of
        `multisample_counts`, for a texture without data that only targets and shaders use. Raises ValueError if it is
        too large, or exceeds `most_bytes`.
        """

    def write(self, texture: Texture, first: int, data: np.ndarray) -> None:
        """Replace whole rows of a texture of four channels, from row `first` on. data: (rows, width, 4) float32."""

    def target(self, colors: list[Texture], depth: Texture | None = None) -> Target:
        """A target with colour textures in slot order, and a depth texture. Make one per frame: framebuffers belong to
        one context."""

    def pipeline(self, description: PipelineDescription) -> Pipeline:
        """A pipeline, compiled and linked on first use, and shared by all equal descriptions.

        The last `PROGRAMS` used are kept. Raises RuntimeError with the pipeline's name if the driver rejects it.
        """

    def draw_triangles(
        self,
        pipeline,
        target,
        triangles: int,
        blocks: list[np.ndarray],
        textures: list[Texture],
        viewport=None,
        first=0,
    ) -> None:
        """Draw this many triangles from number `first` on, in order: vertex 3 t + c is corner c of triangle t.

        blocks: float32 values of each uniform block in std140 layout. The same array is not uploaded twice before
            `restore`, unless `changed` says that it has other values.
        viewport: x, y, width, height in pixels of the part of the target to draw into; None for all of it.
        """

    def draw_fullscreen(
        self, pipeline, target, blocks: list[np.ndarray], textures: list[Texture], viewport=None
    ) -> None:
        """Draw one triangle of three vertices, 0 to 2, that `fullscreen.vert.glsl` stretches over the viewport."""

    def changed(self, block: np.ndarray) -> None:
        """Note that an array of values of a uniform block has others than when it was last drawn with."""

    def finish(self, target: Target) -> None:
        """Wait until drawing into the target is complete."""

    def restore(self) -> None:
        """Restore the graphics state and free what only drawing needed."""
