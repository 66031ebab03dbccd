# SPDX-License-Identifier: GPL-3.0-or-later
"""The largest flat glossy object is a mirror: what it shows is drawn from behind it, once for a view."""

from __future__ import annotations

import numpy as np

from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..probes.flat_pictures import PICTURE_MAPS, window_of
from ..probes.mirrors import mirror_of
from .reflections import missing


def mirror(planning):
    """The frame's mirror, or None: a picture of what is reflected has none."""
    if planning.probes or planning.find(missing):
        return None
    found, others = mirror_of(planning.scene, planning.camera, planning.viewers.lamps)
    if others:
        planning.skip(f"reflections in {others} flat objects", "the largest is the frame's mirror")
    return found


def _to_box(tile) -> np.ndarray:
    """From the view's space to the mirror's box, whose half-axes have length 1."""
    mirror, camera = tile.shared.mirror.mirror, tile.camera.matrix_world
    to_box = np.linalg.inv(np.array(mirror.axes)).T
    matrix = np.eye(4)
    matrix[:3, :3] = to_box @ camera[:3, :3] / tile.view.scale
    matrix[:3, 3] = to_box @ (camera[:3, 3] - mirror.middle)
    return matrix


def _normal(tile) -> tuple[float, ...]:
    """In the view's space."""
    return *(tile.camera.matrix_world[:3, :3].T @ tile.shared.mirror.mirror.normal), 0.0


def _window(tile) -> tuple[float, float, float, float]:
    """As `window_of`, from the right of the mirror's picture, which is turned from left to right."""
    left, *others = window_of(tile, tile.shared.mirror)
    return -left, *others


VALUES = {
    "to_mirror": ("mat4", _to_box),
    "mirror_normal": ("vec4", _normal),
    "mirror_window": ("vec4", _window),
    "mirror_size": ("vec2", lambda tile: tile.shared.mirror.size),
    "mirror_scale": ("float", lambda tile: tile.view.scale),
}
INPUTS = {"mirror_picture": lambda tile: tile.resources.kept(tile.shared.mirror, tile.shared.mirror.texels)}
CONSTANTS = {"PICTURE_MAPS": PICTURE_MAPS}


def passes(planning):
    """None of its own: its picture is drawn before the frame."""
    if planning.shown and planning.find(mirror) is not None:
        planning.has("MIRROR", "a flat glossy object shows what is seen from behind it")
    return ()


def is_present(planning) -> bool:
    return bool(planning.shown) and planning.find(mirror) is not None


def parts(planning, p):
    if p.host in LIT_HOSTS and planning.model.has_finish:
        yield Part("mirrors", inputs=("mirror_picture",))
