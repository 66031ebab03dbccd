# SPDX-License-Identifier: GPL-3.0-or-later
"""One tile of a picture while it is drawn: gives passes their textures, uniform blocks and programs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from ..device.interface import Pipeline, Target
from ..device.interface import Texture as DeviceTexture
from ..features import DRAWN, DRAWS, INPUTS, SAMPLE_VALUES, VALUES
from ..methods import get_method
from ..passes.decisions import has_backdrop
from ..scene import Instance, Scene
from ..scene.camera import Camera
from ..settings import Settings
from ..upload.resources import Resources, TextureKey
from ..view import DrawItem, Items, View
from .batches import instance_texels
from .cut_choice import CutChoice
from .frame_plan import FramePlan
from .graph import Pass, Texture, of_pixels
from .programs import describe
from .repeats import Repeats
from .shared import Shared
from .uniforms import DRAW, INSTANCE, VIEW, Block, instance_values, put, std140

#: What rejects hidden splats reads less than this many pixels beyond their ellipses.
_BESIDE = 24


@dataclass(frozen=True, eq=False)
class TileContext(CutChoice):
    """camera: of the tile, including its margin. view: the scene as that camera sees it.

    shared: by all tiles and samples of the picture.
    rectangle: x, y, width, height in pixels of the tile without its margin, in the picture.
    shown_blocks: of objects with levels, the blocks that passes draw from now on: those of the cut, until some of
        them are found to be hidden.
    is_depth_only: the depth of opaque surfels is all that is seen, as in a shadow map.
    repeats: what it shares with other samples. rise: how far the picture is moved up, in clip space.
    """

    resources: Resources
    plan: FramePlan
    scene: Scene
    camera: Camera
    settings: Settings
    view: View | None
    shared: Shared
    rectangle: tuple[int, int, int, int] = (0, 0, 0, 0)
    shown_blocks: dict[Instance, np.ndarray] = field(default_factory=dict)
    is_depth_only: bool = False
    repeats: Repeats = field(default_factory=Repeats)
    rise: float = 0.0

    def key(self, texture: Texture, is_next: bool = False) -> TextureKey:
        """The key of a texture of the plan; is_next: the second one of a texture that is updated."""
        return texture_key(texture, self.camera.size, self.plan, is_next)

    def texture(self, texture: Texture, is_next: bool = False) -> DeviceTexture:
        """A texture of the plan; is_next: as in `key`."""
        return self.resources.texture(self.key(texture, is_next))

    def swap(self, texture: Texture) -> None:
        """Swap the two textures of one that was updated."""
        self.resources.swap(self.key(texture), self.key(texture, is_next=True))

    def target(self, p: Pass) -> Target:
        """The target that a pass draws into."""
        depth, updated = p.depth if p.state.get("depth_test") else None, p.wiring.updates
        colors = [self.texture(texture, texture in updated) for texture in p.colors]
        return self.resources.device.target(colors, depth and self.texture(depth))

    def clear(self, target: Target, color=None, depth: float | None = None, lasts: bool = False) -> None:
        """Clear a target, as its method does. lasts: only its pass draws into the target, and a part of it alone."""
        self.repeats.call(target.clear, color, depth, lasts=lasts)

    def draw_triangles(self, *call) -> None:
        """Draw, as the method of the device does."""
        self.repeats.call(self.resources.device.draw_triangles, *call)

    def drawn_by(self, p: Pass) -> Items:
        """The splats of the tile's view that a pass draws, except what was found to be hidden."""
        table = self.view.placed.table
        are_drawn = table.of_kinds(lambda instance: all(draws(self, p, instance) for draws in DRAWS))
        return self.view.placed.taken(are_drawn & ~self.hidden[table.numbers])

    @cached_property
    def hidden(self) -> np.ndarray:
        """(n,) bool: the objects of the scene that passes found to be behind all that is seen."""
        return np.zeros(len(self.scene.table), bool)

    def textures(self, p: Pass, program: Pipeline, placed: DrawItem | None = None) -> list[DeviceTexture]:
        """The textures that a program samples. placed: the object being drawn."""
        read = p.wiring.samplers

        def found(name: str) -> DeviceTexture:
            if name in read:
                return self.texture(read[name])
            return DRAWN[name](self, placed) if name in DRAWN else INPUTS[name](self)

        return [found(name) for name in program.description.samplers]

    def blocks(
        self, program: Pipeline, placed: DrawItem | None = None, draw: np.ndarray | None = None
    ) -> list[np.ndarray]:
        """The values of a program's uniform blocks. placed: the object being drawn. draw: those of the draw call."""
        own = {DRAW: lambda: draw, INSTANCE: lambda: self._values_of(placed.items)[placed.row]}
        return [own[block]() if block in own else self._block(block) for block in program.description.blocks]

    def _values_of(self, items: Items) -> np.ndarray:
        """The values of the block of each of the items; kept, because they are asked for one by one."""
        return self.repeats.found((items, "values"), lambda: instance_values(items))

    def instance_table(self, items: Items) -> DeviceTexture:
        """The texture of the values of many instances."""
        return self.shared.table(items.key, self.camera, lambda: self.resources.data(instance_texels(items)))

    def _block(self, block: Block) -> np.ndarray:
        key = self.rise, block
        if key not in self.repeats.blocks:
            self.repeats.blocks[key] = self._values_in(block)
        return self.repeats.blocks[key]

    def _values_in(self, block: Block) -> np.ndarray:
        values = self._view_values if block is VIEW else [VALUES[name][1](self) for _, name in block[2]]
        return std140(block, values)

    def bring_blocks(self) -> None:
        """Give the blocks that another sample from this place made the values of this one."""
        for (rise, block), values in self.repeats.blocks.items():
            if block is VIEW:
                put(block, values, {"projection": self._projection(rise), "window": self.window})
            elif own := {name: VALUES[name][1](self) for _, name in block[2] if name in SAMPLE_VALUES}:
                put(block, values, own)
            else:
                continue
            self.resources.device.changed(values)

    @property
    def _view_values(self):
        to_world = np.eye(4)
        to_world[:3, :3] = self.camera.matrix_world[:3, :3]
        view, is_parallel = self.view, self.camera.is_orthographic
        lengths = self.depth_unit, 1.0 / view.scale
        projection, variance = self._projection(self.rise), self.plan.filter_variance
        return projection, to_world, self.window, view.near, is_parallel, *lengths, variance

    def _projection(self, rise: float) -> np.ndarray:
        projection = self.view.projection
        if rise:
            projection = projection.copy()
            projection[1] += projection[3] * rise
        return projection

    @property
    def depth_unit(self) -> float:
        """Factor from view depth to stored linear depth; 0 if hardware depth is stored."""
        return 1.0 / self.view.far if self.plan.linear_depth else 0.0

    @cached_property
    def window(self) -> tuple[float, float, float, float]:
        """Left, bottom and step of one sample, on the plane at depth 1 or (parallel cameras) in scaled units."""
        left, right, bottom, top = self.camera.window
        units = self.view.scale if self.camera.is_orthographic else 1.0
        across, up = (n * self.plan.samples for n in self.camera.size)
        return left * units, bottom * units, (right - left) / across * units, (top - bottom) / up * units

    def program(self, p: Pass, vertex: str = "fullscreen.vert", *variants: str) -> Pipeline:
        """The program of a pass. variants: of its parts, beside those in all programs."""
        names = vertex, self.plan.linear_depth, *variants
        make = partial(describe, self.plan, p, vertex, *variants)
        return self.shared.program(p, names, lambda: self.resources.pipeline(make()))

    def seen_part(self, p: Pass, beside: int = _BESIDE) -> tuple[int, int, int, int] | None:
        """x, y, width, height of the part of a pass's target outside of which nothing is seen; None for all of it.
        beside: pixels beyond ellipses that count as seen.

        Of textures with samples it includes what filters read beside the pixels that they write.
        """
        is_everywhere = self.plan.find(has_backdrop) or get_method(self.plan.method).widens
        if is_everywhere or self.view.bounds is None:
            return None
        writes_pixels = all(texture.per is of_pixels for texture in p.fills)
        reach, size = beside + self.plan.margin * (1 if writes_pixels else 2), self.camera.size
        low, high = self.view.bounds[:2], self.view.bounds[2:]
        texels = self.plan.size(p.fills[0], size)
        scales = [count / edge for count, edge in zip(texels, size, strict=True)]
        ends = zip(low, high, size, scales, strict=True)
        first, last = zip(
            *(
                (math.floor(min(max(a - reach, 0), edge) * scale), math.ceil(min(max(b + reach, 0), edge) * scale))
                for a, b, edge, scale in ends
            ),
            strict=True,
        )
        return (*first, last[0] - first[0], last[1] - first[1])

    def fill(self, p: Pass, viewport=None) -> Target:
        """Draw over everything that a pass writes, or a part: x, y, width, height of the target."""
        target, program = self.target(p), self.program(p)
        if p.depth and p.state.get("depth_write") and not p.adds:
            self.clear(target, depth=1.0)
        if viewport is None or min(viewport[2:]) > 0:
            blocks, textures = self.blocks(program), self.textures(p, program)
            self.repeats.call(self.resources.device.draw_fullscreen, program, target, blocks, textures, viewport)
        return target


def texture_key(texture: Texture, size: tuple[int, int], plan: FramePlan, is_next: bool = False) -> TextureKey:
    """The key of a plan's texture, for a tile of `size` pixels."""
    known, about = plan.keys, (texture, size, is_next)
    if about not in known:
        name = f"{texture.name}_next" if is_next else texture.name
        known[about] = name, *plan.size(texture, size), plan.format(texture), plan.multisamples_of(texture)
    return known[about]
