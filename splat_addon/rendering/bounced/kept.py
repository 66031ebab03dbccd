# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the bounced light of a renderer's last scene as long as nothing in it changes."""

from __future__ import annotations

import numpy as np

from ..contents import contents
from ..scene import Scene
from .crowns import crowns_of
from .light import BouncedLight, bounced_light
from .solids import are_solid

#: Fields of scenes and instances that bounced light does not depend on: what is not seen still sends light.
_NO_MATTER = frozenset({"is_seen", "is_reflected", "background", "hides_environment", "light_probes"})


#: What a draft gathers, in a fifth of the time: the options of `bounced_light`.
DRAFT = {"rays": 200_000, "voxels": 1 << 18, "surfels": 2000}


class Bounced:
    """The last scene's bounced light, or a draft of it."""

    def __init__(self):
        self._kept: tuple[tuple, BouncedLight] | None = None
        self._is_draft = False

    def of(self, scene: Scene, eye: np.ndarray, bounces: int, is_draft: bool = False) -> BouncedLight:
        """The same object as long as the scene is, and the eye, (3,) world, is in the same rooms. is_draft: whether a
        draft serves, for the first picture of a view."""
        solid = are_solid(scene, eye)
        made_from = bounces, contents(scene, _NO_MATTER), solid.tobytes()
        if self._kept is None or self._kept[0] != made_from or (self._is_draft and not is_draft):
            self._kept = made_from, bounced_light(scene, solid, bounces, **(DRAFT if is_draft else {}))
            self._is_draft = is_draft
        return self._kept[1]

    def of_crowns(self, scene: Scene) -> BouncedLight:
        """What `crowns_of` gives; the same object as long as the scene is."""
        made_from = "crowns", contents(scene, _NO_MATTER | {"lights", "world", "environment"})
        if self._kept is None or self._kept[0] != made_from:
            self._kept = made_from, crowns_of(scene)
        return self._kept[1]

    def forget(self) -> None:
        self._kept = None
