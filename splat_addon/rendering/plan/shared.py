# SPDX-License-Identifier: GPL-3.0-or-later
"""What all tiles and samples of a planned picture share, found once."""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable
from functools import cached_property
from typing import TypeVar

from ..bounced.light import BouncedLight
from ..depth_range import ClipRange, clip_range
from ..detail.history import NOTHING, History
from ..device.interface import Pipeline, Texture, texture_bytes
from ..identity import Identities
from ..passes.decisions import shadows
from ..probes.mirrors import MirrorPicture
from ..probes.pictures import ProbePictures
from ..probes.screen import ScreenPicture
from ..sample_views import SampleViews, clip_around
from ..scene import Instance, Scene
from ..scene.camera import Camera
from ..scene.glass_surfaces import GlassSurfaces
from ..settings import Settings
from ..shadows.atlas import ShadowMap
from ..view import View, build_view
from .frame_plan import FramePlan
from .graph import Pass
from .repeats import Repeats

Made = TypeVar("Made")

#: Bytes of the tables of instances that are kept.
_MOST_BYTES = 1 << 26


class Shared:
    """A scene, the plan of its picture, and what depends on nothing else. samples: of the picture that are drawn one
    right after the other. history: as of `plan`. probes, mirror, screen: what the plan's probes see,
    and its mirror, and the camera, if rays are followed in that. bounced: the scene's light, and glass_surfaces: its
    glass, if the plan needs them."""

    def __init__(
        self,
        scene: Scene,
        plan: FramePlan,
        settings: Settings,
        samples: int = 1,
        history: History = NOTHING,
        probes: ProbePictures | None = None,
        mirror: MirrorPicture | None = None,
        screen: ScreenPicture | None = None,
        bounced: BouncedLight | None = None,
        glass_surfaces: GlassSurfaces | None = None,
    ):
        self.scene, self.plan, self.settings, self.samples, self.history = scene, plan, settings, samples, history
        self.probes, self.mirror, self.screen, self.bounced = probes, mirror, screen, bounced
        self.glass_surfaces = glass_surfaces
        self._kept: dict[Hashable, object] = {}
        self._tables: dict[tuple[bytes, bytes], Texture] = {}
        self._programs: dict[tuple, tuple[Pass, Pipeline]] = {}

    def kept(self, key: Hashable, make: Callable[[], Made]) -> Made:
        """What was made for a key."""
        if key not in self._kept:
            self._kept[key] = make()
        return self._kept[key]

    def table(self, key: bytes, camera: Camera, make: Callable[[], Texture]) -> Texture:
        """The table of instances with this key, from the place of a camera, whichever window it looks through. The last
        ones are kept."""
        key = camera.matrix_world.tobytes(), key
        if key not in self._tables:
            made = make()
            while self._tables and texture_bytes([made, *self._tables.values()]) > _MOST_BYTES:
                del self._tables[next(iter(self._tables))]
            self._tables[key] = made
        return self._tables[key]

    @cached_property
    def _are_alike(self) -> bool:
        """Whether samples have one view; of far-reaching triangles each shows other pieces."""
        return self.samples > 1 and not len(self.scene.table.firm.reaching)

    def whole(self, camera: Camera) -> ClipRange:
        """The clip range of a picture that is drawn in tiles. camera: of all of it."""
        if not self._are_alike:
            return clip_range(self.scene.table.seen, camera, *self._epsilons)
        key = "whole", camera.matrix_world.tobytes()
        return self.kept(key, lambda: clip_around(self.scene.table.seen, camera, *self._epsilons))

    @property
    def _epsilons(self) -> tuple[float, float]:
        return self.settings.epsilon, self.settings.epsilon_length

    def view(self, tile: int, camera: Camera, whole: ClipRange | None) -> View:
        """The scene as the camera of a tile and sample sees it. whole: as of `build_view`."""
        table, (epsilon, length) = self.scene.table.seen, self._epsilons
        if not self._are_alike:
            return build_view(table, camera, epsilon, whole, epsilon_length=length)
        key = "views", tile, camera.matrix_world.tobytes()
        return self.kept(key, lambda: SampleViews(table, camera, whole, epsilon, length)).of(camera)

    def repeats(self, tile: int, camera: Camera) -> Repeats:
        """What a sample of a tile shares with the others from the place of its camera."""
        if not self._are_alike:
            return Repeats()
        may_repeat = self.plan.may_repeat and len(self.plan.tiles) == 1
        repeats = self.kept(("repeats", tile, camera.matrix_world.tobytes()), lambda: Repeats(may_repeat))
        return repeats if repeats.records else Repeats()

    def program(self, p: Pass, names: tuple, make: Callable[[], Pipeline]) -> Pipeline:
        """The program of a pass with these names of its vertex shader and variants."""
        known = self._programs.get((id(p), names))
        if known is None or known[0] is not p:
            known = self._programs[id(p), names] = p, make()
        return known[1]

    @cached_property
    def shadow_views(self) -> tuple[View, ...]:
        """The shadow casters as seen by the camera of each shadow map."""
        return tuple(self._seen_by_light(made) for made in self.plan.find(shadows).maps)

    def _seen_by_light(self, made: ShadowMap) -> View:
        """What is drawn into a shadow map. The range of a sun's depths is that of all casters around, because its
        lookups depend on it."""
        epsilon, whole = self.settings.epsilon, None
        if made.camera.is_orthographic:
            whole = clip_range(made.around, made.camera, epsilon)
        return build_view(made.casters, made.drawn, epsilon, whole, are_split=False)

    @cached_property
    def identities(self) -> Identities:
        """The meaning of the scene's numbers."""
        return Identities(self.scene)

    @cached_property
    def color_scale(self) -> float:
        """Factor by which float16 sums multiply colours: a power of two that brings the scene's brightest colour to at
        most 1."""
        if self.plan.sum_format == "float32":
            return 1.0
        instances = [kind.placed for kind in self.scene.table.kinds if isinstance(kind.placed, Instance)]
        surfels = [instance.surfels for instance in instances]  # polygons are not summed
        textures = [t for instance in instances if instance.is_textured for t in instance.textures if t]
        brightest = max((source.brightest for source in (*surfels, *textures)), default=0.0)
        return math.ldexp(1.0, -math.ceil(math.log2(brightest))) if brightest > 0 else 1.0
