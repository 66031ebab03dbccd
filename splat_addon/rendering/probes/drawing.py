# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the pictures of a scene's probes and mirror and of what the camera sees, and keeps them as long as nothing in
the scene changes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ..assembly.panorama_faces import panorama_frame
from ..contents import contents
from ..frame import Frame
from ..scene import Placed, Scene
from ..scene.camera import Camera
from ..scene.glass_surfaces import GlassSurfaces
from ..scene.octahedral import Octahedral
from ..scene.panorama import Panorama
from ..scene.placements import Placements
from ..settings import Settings
from ..shadows.receivers import Viewers
from .glass import GlassApart, surfaces_of
from .mirrors import Mirror, MirrorPicture, mirrored_camera
from .pictures import ProbePictures
from .places import Probe
from .screen import ScreenPicture, wider_camera

#: (what a probe sees, a face's camera, the cameras that its shadow maps serve, settings, what probes saw) -> Frame
Draw = Callable[[Scene, Camera, Viewers, Settings, ProbePictures | None], Frame]

#: Of a probe's radius, how far away something must be to be seen; and of the farthest thing, how far it sees.
_NEAREST, _FARTHEST = 1e-3, 1.01


class Probes:
    """The pictures of one renderer's last scene, and of the last view's mirror."""

    def __init__(self):
        self._kept: tuple[tuple, ProbePictures, bool] | None = None
        self._mirrored: tuple[tuple, MirrorPicture] | None = None
        self._surfaces: tuple[tuple, GlassSurfaces] | None = None
        self._screen: tuple[tuple, ScreenPicture] | None = None
        self.apart = GlassApart()

    def pictures(
        self, scene: Scene, probes: tuple[Probe, ...], side: int, settings: Settings, draw: Draw, is_draft: bool,
        is_repeatable: bool,
    ) -> ProbePictures:  # fmt: skip
        """What the probes see: the same object as long as the scene is, and no finer one is needed.

        side: texels along that of each picture. is_draft: what glossy things show of one another may be missing.
        is_repeatable: as in `Renderer.render`.
        """
        plain = _plain(settings)
        is_whole = not (is_draft and any(probe.sees_others for probe in probes))
        made_from = probes, plain, settings.refraction, contents(scene)
        if self._kept is not None and self._kept[0] == made_from:
            _, kept, was_whole = self._kept
            if (kept.side == side or (kept.side > side and not is_repeatable)) and was_whole >= is_whole:
                return kept

        def taken(probe: Probe, known: ProbePictures | None) -> Frame:
            seen, chosen = _left_out(scene, probe.left_out), _reflecting(plain, known)
            panorama = _panorama(scene, probe, (side + 2, side + 2))

            def drawn(camera, of, settings, progress) -> Frame:
                return draw(seen, camera, of, settings, known)

            return panorama_frame(panorama, 0, chosen, drawn)

        frames = [taken(probe, None) for probe in probes]
        made = ProbePictures(probes, frames)
        if is_whole and any(probe.sees_others for probe in probes):
            pairs = zip(probes, frames, strict=True)
            made = ProbePictures(probes, [taken(probe, made) if probe.sees_others else frame for probe, frame in pairs])
        self._kept = made_from, made, is_whole
        return made

    def mirror(
        self, scene: Scene, mirror: Mirror, camera: Camera, settings: Settings, known: ProbePictures | None, draw: Draw
    ) -> MirrorPicture:
        """What the mirror shows to a camera: the same object as long as both stay. known: what the probes see."""
        plain = replace(_reflecting(_plain(settings), known), supersampling=2)
        behind = mirrored_camera(mirror, camera)
        view = behind.matrix_world.tobytes(), behind.window, behind.size, behind.near, behind.far
        made_from = mirror, view, behind.is_orthographic, plain, known, settings.refraction, contents(scene)
        if self._mirrored is None or self._mirrored[0] != made_from:
            seen = draw(_left_out(scene, mirror.left_out), behind, Viewers(behind, (behind,)), plain, known)
            self._mirrored = made_from, MirrorPicture(mirror, behind, seen)
        return self._mirrored[1]

    def screen(
        self, scene: Scene, camera: Camera, settings: Settings, known: ProbePictures | None, draw: Draw,
        is_behind_glass: bool, is_looked_up: bool,
    ) -> ScreenPicture:  # fmt: skip
        """What a camera sees: the same object as long as both stay. known: what the probes see. is_behind_glass:
        whether it is seen through glass; otherwise only what reflections show is in it. is_looked_up: whether the
        camera is a probe's or behind a mirror: its picture has enough samples for what others look up in it."""
        # what is reflected is made smaller by most surfaces
        edge = (settings.supersampling if is_looked_up else 2) if is_behind_glass else 1
        plain = replace(_reflecting(_plain(settings), known), supersampling=edge)
        wider, of_scene = wider_camera(camera), contents(scene)
        view = wider.matrix_world.tobytes(), wider.window, wider.size, wider.near, wider.far
        made_from = view, wider.is_orthographic, plain, known, of_scene, settings.refraction, is_behind_glass
        if self._screen is None or self._screen[0] != made_from:
            of = self.apart.without(scene) if is_behind_glass else _left_out(scene, ())
            self._screen = made_from, ScreenPicture(wider, draw(of, wider, Viewers(wider, (wider,)), plain, known))
        return self._screen[1]

    def surfaces(self, scene: Scene) -> GlassSurfaces:
        """The scene's glass: the same object as long as the scene is."""
        of_scene = contents(scene)
        if self._surfaces is None or self._surfaces[0] != of_scene:
            self._surfaces = of_scene, surfaces_of(scene.table)
        return self._surfaces[1]

    def forget(self) -> None:
        self._kept = self._mirrored = self._surfaces = self._screen = None


def _plain(settings: Settings) -> Settings:
    """Settings for what probes see: blurred and filtered later, and without what things in it reflect."""
    return replace(
        settings, method="quad", lines=None, eye_dome=None, supersampling=1, samples=1, multisampling=0,
        edge_threshold=0.0, filter_variance=Settings.filter_variance, reflections=False,
        transparent_film=True, as_printed=False, outputs=("color", "depth"), profile=False,
    )  # fmt: skip


def _reflecting(plain: Settings, known: ProbePictures | None) -> Settings:
    """The settings for pictures in which glossy things show what probes saw, if that is known."""
    return replace(plain, reflections=known is not None)


def _panorama(scene: Scene, probe: Probe, size: tuple[int, int]) -> Panorama:
    matrix = np.eye(4)
    matrix[:3, 3] = probe.middle
    away = np.linalg.norm(scene.table.world_corners.reshape(-1, 3) - probe.middle, axis=1).max()
    near = _NEAREST * probe.radius
    return Panorama(matrix, Octahedral(size[0] - 2), size, near, max(_FARTHEST * away, 2 * near))


def _left_out(scene: Scene, rows: tuple[int, ...]) -> Scene:
    """The scene of which reflections are seen, where what is in these rows of its table only casts its shadow."""
    left_out = {scene.table.placed[row] for row in rows}
    if not left_out and all(kind.placed.is_seen == kind.placed.is_reflected for kind in scene.table.kinds):
        return scene

    def of(placed: Placements) -> Placements | tuple[Placed, ...]:
        if not left_out:
            return placed.changed(lambda one: _seen(one, one.is_reflected))
        return tuple(_seen(one, one.is_reflected and one not in left_out) for one in placed)

    return replace(scene, surfels=of(scene.surfels), polygons=of(scene.polygons))


def _seen(placed: Placed, is_seen: bool) -> Placed:
    return placed if placed.is_seen == is_seen else replace(placed, is_seen=is_seen)
