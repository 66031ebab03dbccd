# SPDX-License-Identifier: GPL-3.0-or-later
"""Glossy surfaces reflect what stands around them: probes see it, and rays are traced among what they see (Lagarde and
Zanuttini 2012; Szirmay-Kalos et al. 2005)."""

from __future__ import annotations

import numpy as np

from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..probes.pictures import HEADER, MAPS, side_of
from ..probes.places import MAX_PROBES, probes_of


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
        planning.skip(f"reflections of {without} objects", f"there is room for {MAX_PROBES} probes")
    return found


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
INPUTS = {"probes": lambda tile: tile.resources.kept(tile.shared.probes, tile.shared.probes.texels)}
CONSTANTS = {"PROBE_HEADER": HEADER, "PROBE_MAPS": MAPS}


def passes(planning):
    """None of its own: probes are drawn before the frame, and only when the scene has changed."""
    if planning.shown and (found := planning.find(probes)):
        planning.find(side)
        planning.has("REFLECTIONS", f"{len(found)} probes see what glossy objects reflect")
    return ()


def is_present(planning) -> bool:
    return bool(planning.shown and planning.find(probes))


def parts(planning, p):
    if p.host in LIT_HOSTS and planning.model.has_finish:
        yield Part("reflections", inputs=("probes",))
