# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy surfaces reflect what stands around them: rays are followed in what the camera sees (McGuire and Mara 2014),
and else among what probes see (Lagarde and Zanuttini 2012; Szirmay-Kalos et al. 2005)."""

from __future__ import annotations

import numpy as np

from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..plan.planning import any_of
from ..probes.pictures import HEADER, MAPS, side_of
from ..probes.places import MAX_PROBES, probes_of
from .glass import glass


def probes(planning):
    """The probes of the frame."""
    if why := planning.find(missing):
        planning.skip("reflections", why)
        return ()
    if planning.probes:
        return planning.probes
    found, without = probes_of(planning.scene, planning.around)
    if not found:
        planning.skip("reflections", "nothing that is not flat is glossy")
    if without:
        planning.lack(f"reflections of {without} objects", _NO_ROOM.format(without))
    return found


def sees_screen(planning) -> bool:
    """Whether reflections show what the camera sees, where rays meet that."""
    if planning.probes or not planning.shown or not planning.find(probes):
        return False
    what, kinds = "reflections of what the camera sees", planning.scene.table.kinds
    if planning.find(glass) and any_of(lambda placed: placed.is_seen != placed.is_reflected, kinds):
        planning.skip(what, "through glass, more is seen than is reflected")
        return False
    turned = planning.camera.matrix_world[:3, :3].tobytes()
    if any(one.matrix_world[:3, :3].tobytes() != turned for one in planning.viewers.lamps):
        planning.skip(what, "the borders of a panorama's faces would show")
        return False
    return True


_NO_ROOM = (
    f"{{:,}} glossy objects reflect only the world and what the camera sees, as a picture has {MAX_PROBES} probes; "
    "place sphere light probes that have several objects in their boxes"
)


def side(planning) -> int:
    """Texels along the side of what each probe sees."""
    return side_of(planning.find(probes), planning.around)


def missing(planning) -> str:
    """The reason why the frame has no reflections, or ""."""
    if not planning.settings.reflections:
        return "they are switched off"
    if not planning.model.has_finish:
        return f"{planning.model.name} shading has none"
    if planning.settings.lights_splats:
        return "splats are lit one by one"
    return ""


def _to_probes(tile) -> np.ndarray:
    """From the view's space to the world's, relative to the probes' origin."""
    matrix, place = np.eye(4), tile.camera.matrix_world
    matrix[:3, :3] = place[:3, :3] / tile.view.scale
    matrix[:3, 3] = place[:3, 3] - tile.shared.probes.origin
    return matrix


VALUES = {
    "probe_count": ("float", lambda tile: len(tile.plan.find(probes))),
    "probe_side": ("float", lambda tile: tile.shared.probes.side),
    "to_probes": ("mat4", _to_probes),
}
SAMPLE_VALUES = {
    # the picture's first sample of a pixel, and how many there are along its edges
    "reflected_sample": ("vec2", lambda tile: (tile.camera.sample * tile.plan.samples**2, tile.plan.samples)),
}
INPUTS = {"probes": lambda tile: tile.resources.kept(tile.shared.probes, tile.shared.probes.texels)}
CONSTANTS = {"PROBE_HEADER": HEADER, "PROBE_MAPS": MAPS}


def passes(planning):
    """None of its own: probes are drawn before the frame, and only when the scene has changed."""
    if planning.shown and (found := planning.find(probes)):
        planning.find(side)
        also = " where the camera does not" if planning.find(sees_screen) else ""
        planning.has("REFLECTIONS", f"{len(found)} probes see what glossy objects reflect{also}")
    return ()


def is_present(planning) -> bool:
    return bool(planning.shown and planning.find(probes))


def parts(planning, p):
    if p.host in LIT_HOSTS and planning.model.has_finish:
        sees = planning.find(sees_screen)
        words, pictures = (("on_screen",), ("screen_picture",)) if sees else (("off_screen",), ())
        yield Part("reflections", words, inputs=("probes", *pictures))
