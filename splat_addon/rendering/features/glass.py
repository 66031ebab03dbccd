# SPDX-License-Identifier: GPL-3.0-or-later
"""Glass shows what is behind it: light is followed through its surfaces, and ends in a picture without it."""

from __future__ import annotations

import math

import numpy as np

from ..plan.graph import Part
from ..plan.hosts import LIT_HOSTS
from ..plan.planning import any_of
from ..probes.glass import has_glass
from ..scene import Scene
from ..scene.glass_surfaces import LEAF, ROW_BITS
from ..settings import Settings
from ..shading_models import get_shading_model
from ..shadows.casters import sees


def glass(planning) -> bool:
    """Whether the frame shows what is behind glass."""
    if not planning.shown or not any_of(has_glass, planning.scene.table.seen.kinds):
        return False
    if why := why_opaque(planning.settings):
        planning.skip("glass", f"it is drawn opaque: {why}")
        return False
    # what reflections are followed in must not depend on which part of a picture is drawn
    follows_reflections = planning.settings.reflections and not planning.probes
    if not follows_reflections and not _may_show(planning):
        planning.skip("glass", "the picture shows none")
        return False
    return True


def _may_show(planning) -> bool:
    """Whether glass may be in the picture or close beside it: most faces of a probe see none."""
    camera, table = planning.camera, planning.scene.table.seen
    if camera.lens is not None:
        return True
    corners = table.taken(table.of_kinds(has_glass)).world_corners
    width, height = camera.size
    return bool(sees(camera.cropped(-_BESIDE, -_BESIDE, width + 2 * _BESIDE, height + 2 * _BESIDE), corners).any())


#: Pixels beside a picture that its filters may read.
_BESIDE = 16


def shadows(planning) -> bool:
    """Whether lights are followed through glass."""
    return planning.shown and planning.model.is_lit and tints_shadows(planning.scene, planning.settings)


def is_drawn(scene: Scene, settings: Settings) -> bool:
    """Whether light is followed through the glass of a scene, if it has any."""
    return not why_opaque(settings) and any_of(has_glass, scene.table.kinds)


def tints_shadows(scene: Scene, settings: Settings) -> bool:
    """Whether glass is no caster of what shadow maps see, but tints the lights that cast shadows."""
    casts = settings.shadow_resolution > 0 and any(light.casts_shadow for light in scene.lights)
    return casts and is_drawn(scene, settings)


def why_opaque(settings: Settings) -> str:
    """The reason why glass is opaque, or ""."""
    if not settings.refraction:
        return "refraction is switched off"
    model = get_shading_model(settings.shading)
    if not model.has_finish:
        return f"{model.name} shading has none"
    return "splats are lit one by one" if settings.lights_splats else ""


def _to_glass(tile) -> np.ndarray:
    """From the view's space to that of the surfaces: the world's, relative to their origin."""
    matrix, place = np.eye(4), tile.camera.matrix_world
    matrix[:3, :3] = place[:3, :3] / tile.view.scale
    matrix[:3, 3] = place[:3, 3] - tile.shared.glass_surfaces.origin
    return matrix


#: Successive samples turn the rays behind rough glass by fractions of a turn that fill it evenly (the golden ratio).
_TURN = math.pi * (math.sqrt(5) - 1)
#: The same of their way from the middle of a lamp to its rim: its area is filled evenly beside the turns.
_ASIDE = math.sqrt(2) - 1

VALUES = {
    "to_glass": ("mat4", _to_glass),
    "from_glass": ("mat4", lambda tile: np.linalg.inv(_to_glass(tile))),
    "glass_leaves": ("float", lambda tile: tile.shared.glass_surfaces.leaves),
}
SAMPLE_VALUES = {
    "glass_aside": ("float", lambda tile: math.sqrt(_ASIDE * tile.camera.sample % 1)),
    "glass_turn": ("float", lambda tile: _TURN * tile.camera.sample % (2 * math.pi)),
}
INPUTS = {
    "glass_surfaces": lambda tile: tile.resources.kept(tile.shared.glass_surfaces, tile.shared.glass_surfaces.texels),
}
CONSTANTS = {
    "GLASS_LEAF": LEAF,
    "GLASS_ROW_BITS": ROW_BITS,
}


def passes(planning):
    """None of its own: what is behind glass is drawn before the frame."""
    if planning.find(glass):
        planning.has("GLASS", "light is followed through glass to what is behind it")
    if planning.find(shadows):
        planning.has("GLASS SHADOWS", "lights are followed through glass")
    return ()


def is_present(planning) -> bool:
    return planning.find(glass) or planning.find(shadows)


def parts(planning, p):
    if p.host in LIT_HOSTS and planning.model.has_finish:
        words = tuple(word for word, of in (("see_through", glass), ("glass_shadows", shadows)) if planning.find(of))
        behind = ("screen_picture",) if planning.find(glass) else ()
        yield Part("glass", words, inputs=(*behind, "glass_surfaces"))
