# SPDX-License-Identifier: GPL-3.0-or-later
"""Plans pictures, and brings what a plan needs beside its scene: what probes, a mirror and a camera behind glass see,
and the light between surfaces."""

from __future__ import annotations

from collections.abc import Callable
from weakref import WeakSet

import numpy as np

from ..surfels import Surfels
from .assembly.near_and_far import NearAndFar
from .bounced.kept import Bounced
from .detail.history import history, no_history
from .features import bounced_light, crowns, glass, mirrors, reflections, screen
from .features.outputs import check_samplers
from .frame import Frame
from .plan.build import plan
from .plan.frame_plan import FramePlan
from .plan.shared import Shared
from .probes.drawing import Probes
from .probes.pictures import ProbePictures
from .scene import Scene
from .scene.camera import Camera
from .scene.glass_surfaces import GlassSurfaces
from .settings import Settings
from .shadows.receivers import Viewers


class Planner:
    """What one renderer keeps to plan its next picture. draw: draws a picture that another needs. most_samplers: of the
    device."""

    def __init__(self, draw: Callable[[Shared, Camera], Frame], most_samplers: int):
        self._draw, self._most_samplers = draw, most_samplers
        self.near_and_far = NearAndFar()
        self.probes = Probes()
        self.bounced = Bounced()
        self._drawn: WeakSet[Surfels] = WeakSet()

    def planned(
        self,
        scene: Scene,
        camera: Camera,
        settings: Settings,
        repeated=1,
        is_repeatable=False,
        whole: Scene | None = None,
        eye: np.ndarray | None = None,
        is_draft: bool = False,
        known: ProbePictures | None = None,
        panes: GlassSurfaces | None = None,
        **options,
    ) -> Shared:
        """The plan of a picture and all that its samples share. repeated: how many samples follow one another. whole:
        the scene that lights what is drawn, if that is only a part. eye: where the viewer is, if the camera is a
        probe's or behind a mirror. is_draft: whether a better picture follows. known: what probes saw, if the picture
        is of what is reflected. panes: the glass of the scene, if it is known. options: of `plan`."""
        is_looked_up = eye is not None
        eye = camera.matrix_world[:3, 3] if eye is None else eye
        whole, scene = whole or scene, self.near_and_far.resolved(scene, camera)
        if glass.is_drawn(scene, settings):
            panes = panes or self.probes.surfaces(scene)
            scene = self.probes.apart.without_shadows(scene) if glass.tints_shadows(scene, settings) else scene
        before = no_history(scene) if is_repeatable else history(scene, self._drawn)
        probes = known.probes if known else ()
        frame_plan = plan(scene, camera, settings, history=before, probes=probes, **options)
        check_samplers(frame_plan, self._most_samplers)
        told = {"is_repeatable": is_repeatable, "whole": whole, "eye": eye, "is_draft": is_draft, "panes": panes}
        seen = self._reflected(scene, camera, settings, frame_plan, told, known, is_looked_up)
        light = self._bounced(whole, frame_plan, settings, eye, is_draft)
        return Shared(scene, frame_plan, settings, repeated, before, *seen, light, panes)

    def _bounced(self, whole: Scene, frame_plan: FramePlan, settings: Settings, eye: np.ndarray, is_draft: bool):
        """What cells of space know of the light in a scene, if the plan looks it up."""
        if not frame_plan.passes:
            return None
        if frame_plan.found.get(bounced_light.missing) == "":
            return self.bounced.of(whole, eye, settings.bounces, is_draft)
        return self.bounced.of_crowns(whole) if frame_plan.found.get(crowns.crowns) else None

    def _reflected(
        self, scene: Scene, camera: Camera, settings: Settings, frame_plan: FramePlan, told: dict,
        known: ProbePictures | None, is_looked_up: bool,
    ):  # fmt: skip
        """What the plan's probes and mirror see, and the camera, drawn if anything in it has changed; None for what it
        lacks. told: options of `planned`. known: what probes saw, if the picture is of what is reflected. is_looked_up:
        whether the camera is a probe's or behind a mirror."""

        def draw(seen: Scene, camera: Camera, of: Viewers, plain: Settings, known: ProbePictures | None) -> Frame:
            shared = self.planned(seen, camera, plain, viewers=of, known=known, **told)
            return self._draw(shared, camera)

        found, kept = frame_plan.found, self.probes
        if known is None and (probes := found.get(reflections.probes)):
            how = told["is_draft"], told["is_repeatable"]
            known = kept.pictures(scene, probes, found[reflections.side], settings, draw, *how)
        mirror, of = found.get(mirrors.mirror), (camera, settings, known, draw)
        return (
            known,
            kept.mirror(scene, mirror, *of) if mirror else None,
            kept.screen(scene, *of, found[glass.glass], is_looked_up) if found.get(screen.is_seen) else None,
        )

    def was_drawn(self, scene: Scene) -> None:
        """A picture of the scene is complete."""
        self._drawn.update(shape for shape in scene.table.shapes if isinstance(shape, Surfels))

    def forget(self) -> None:
        """Forget what other pictures showed."""
        self.probes.forget()
        self.bounced.forget()
