# SPDX-License-Identifier: GPL-3.0-or-later
"""What every pass is given: one tile of the picture, and what is drawn into it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..camera import Camera
from ..device.interface import Texture
from ..frame_plan import FramePlan
from ..identity import Identities
from ..resources import Resources, TextureKey
from ..scene import Scene
from ..settings import Settings
from ..uniforms import DRAW, FRAME_VALUES, VIEW, Block, std140
from ..view import View


@dataclass(frozen=True, eq=False)
class TileContext:
    """camera: of the tile with its margin. view: the scene as that camera sees it.

    shadow_views: what casts shadows as the camera of each of the plan's shadow maps sees it.
    rectangle: x, y, width, height in pixels of the tile without its margin, in the picture.
    """

    resources: Resources
    plan: FramePlan
    scene: Scene
    camera: Camera
    settings: Settings
    view: View
    shadow_views: tuple[View, ...] = ()
    rectangle: tuple[int, int, int, int] = (0, 0, 0, 0)

    def texture(self, name: str) -> Texture:
        """One that the plan names."""
        return self.resources.texture(texture_key(name, self.camera.size, self.plan))

    def swap(self, name: str, other: str) -> None:
        """Let two textures of one size and format change their names."""
        self.resources.swap(*(texture_key(n, self.camera.size, self.plan) for n in (name, other)))

    @cached_property
    def _blocks(self) -> dict:
        return {}

    def blocks(self, blocks: tuple[Block, ...], draw: np.ndarray | None = None) -> list[np.ndarray]:
        """The values of a pipeline's blocks. draw: of what is drawn."""
        return [draw if block is DRAW else self._block(block) for block in blocks]

    def _block(self, block: Block) -> np.ndarray:
        if block not in self._blocks:
            if block is VIEW:
                values = self._view_values()
            else:
                values = [FRAME_VALUES[name][1](self) for _, name in block[2]]
            self._blocks[block] = std140(block, values)
        return self._blocks[block]

    def _view_values(self):
        to_world = np.eye(4)
        to_world[:3, :3] = self.camera.matrix_world[:3, :3]
        view, is_parallel = self.view, self.camera.is_orthographic
        return view.projection, to_world, self.window, view.near, is_parallel, self.depth_unit, 1.0 / view.scale

    def textures(self, names: tuple[str, ...], made_here: dict[str, Callable[[], Texture]]) -> list[Texture]:
        """Those that the plan names and those that `made_here` makes, in the order of `names`."""
        return [made_here[name]() if name in made_here else self.texture(name) for name in names]

    def target(self, colors: tuple[str, ...], depth: str | None = None):
        """The named textures to draw into."""
        return self.resources.device.target([self.texture(name) for name in colors], depth and self.texture(depth))

    @cached_property
    def identities(self) -> Identities:
        """What the scene's numbers mean; they tell instances apart in transparent shadows too."""
        return Identities(self.scene)

    @property
    def depth_unit(self) -> float:
        """What turns a depth of the view into a stored linear one; 0 where the hardware's depth is stored."""
        return 1.0 / self.view.far if self.plan.linear_depth else 0.0

    @cached_property
    def color_scale(self) -> float:
        """What float16 sums multiply colours by, a power of two: the scene's brightest is then at most 1."""
        if self.plan.accumulation == "float32":
            return 1.0
        surfels = [instance.surfels for instance in self.scene.surfels]  # polygons are not summed
        textures = [t for instance in self.scene.surfels if instance.is_textured for t in instance.textures if t]
        brightest = max((source.brightest for source in (*surfels, *textures)), default=0.0)
        return math.ldexp(1.0, -math.ceil(math.log2(brightest))) if brightest > 0 else 1.0

    @property
    def window(self) -> tuple[float, float, float, float]:
        """Left, bottom and step of one sample, on the plane at depth 1 or (parallel cameras) in scaled units."""
        left, right, bottom, top = self.camera.window
        units = self.view.scale if self.camera.is_orthographic else 1.0
        across, up = (n * self.plan.samples for n in self.camera.size)
        return left * units, bottom * units, (right - left) / across * units, (top - bottom) / up * units


def texture_key(name: str, size: tuple[int, int], plan: FramePlan) -> TextureKey:
    """Of a texture of the plan, for a tile of `size` pixels."""
    return name, *plan.size(name, size), plan.format(name), plan.multisamples_of(name)
