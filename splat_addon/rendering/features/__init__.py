# SPDX-License-Identifier: GPL-3.0-or-later
"""The features that a frame may need, in the order of their passes and of their calls at a hook.

Each module decides from a `Planning` whether the frame needs it, and records the reason if not. It may have

    passes(planning)       its passes, if the frame needs them
    is_present(planning)   whether it has any parts, if that does not depend on the pass
    parts(planning, p)     its parts in the passes of others, and in its own
    read_back(planning)    textures that are read back when the frame is complete
    check(plan)            raises ValueError for a plan that no device has room for
    VALUES                 name -> (type, value for a tile) of its values in the uniform block `frame`
    SAMPLE_VALUES          the same of those that differ between samples from one place
    INPUTS                 sampler -> the texture for a tile that no pass writes
    DRAWN                  sampler -> the texture for a tile and what is drawn (a `DrawItem`)
    ARRIVES                those of them with one texel or more per surfel -> whether an instance needs it
    draws(tile, p, i)      whether a pass draws the splats of an instance
    CONSTANTS              constants that Python and shaders share, by name
    margin(planning)       pixels beside a tile that its functions read
    NAMES                  the names of its files in shaders/features, unless it has a single one of its own name
"""

from difflib import get_close_matches
from inspect import isfunction

from ..passes import drawing
from ..scene.polygons import CORNERS_PER_ROW, TEXELS_PER_CORNER
from ..shading_models import SHADING_MODELS
from ..upload.packing import BLEND_STEPS, SPLATS_PER_ROW, TEXELS_PER_SPLAT
from . import (
    ambient_occlusion,
    back_culling,
    blend_depth,
    bounced_light,
    clip_lines,
    crowns,
    cut_outs,
    depth_bounds,
    depth_format,
    edge_threshold,
    eye_dome,
    finish,
    folds,
    gbuffer,
    glass,
    gloss_maps,
    hidden_backs,
    hidden_objects,
    hiz,
    holdout,
    levels,
    lighting,
    lights,
    lines,
    lit_splats,
    materials,
    merged_size,
    mirrors,
    near_clipped,
    nearest_splats,
    normal_fields,
    normal_maps,
    object_id,
    oit,
    outputs,
    polygons,
    reflections,
    sample_depths,
    sample_sum,
    screen,
    shadows,
    silhouettes,
    splat_holes,
    split,
    styles,
    textures,
    together,
    transparency,
    transparent_shadows,
    visibility,
    world,
)

FEATURES = (
    world,
    levels,
    merged_size,
    depth_format,
    near_clipped,
    split,
    blend_depth,
    back_culling,
    hidden_backs,
    shadows,
    hidden_objects,
    visibility,
    object_id,
    transparency,
    transparent_shadows,
    holdout,
    silhouettes,
    depth_bounds,
    hiz,
    materials,
    finish,
    lights,
    textures,
    normal_maps,
    gloss_maps,
    cut_outs,
    splat_holes,
    lit_splats,
    normal_fields,
    gbuffer,
    nearest_splats,
    oit,
    clip_lines,
    folds,
    polygons,
    sample_depths,
    ambient_occlusion,
    crowns,
    bounced_light,
    reflections,
    mirrors,
    glass,
    screen,
    eye_dome,
    outputs,
    styles,
    lines,
    edge_threshold,
    lighting,
    sample_sum,
    together,
)


#: member -> how many parameters it takes; 0 for tables
_MEMBERS = {"passes": 1, "is_present": 1, "parts": 2, "read_back": 1, "check": 1, "draws": 3, "margin": 1}
_MEMBERS |= dict.fromkeys(("VALUES", "SAMPLE_VALUES", "INPUTS", "DRAWN", "ARRIVES", "CONSTANTS", "NAMES"), 0)

#: The share of letters that a misspelt name has in common with what it means.
_ALIKE = 0.8


def check_members(feature) -> None:
    """Raise TypeError for a member of a feature that takes other parameters, or whose name is nearly one: it would be
    absent, and nobody would know."""
    for name, value in vars(feature).items():
        if name.startswith("_") or not (isfunction(value) or isinstance(value, dict | tuple)):
            continue
        takes = value.__code__.co_argcount if isfunction(value) else 0
        if name in _MEMBERS and takes != _MEMBERS[name]:
            raise TypeError(f"{feature.__name__}.{name} takes {takes} parameters, and must take {_MEMBERS[name]}.")
        alike = [member for member, count in _MEMBERS.items() if count == takes and name not in _MEMBERS]
        if meant := get_close_matches(name, alike, 1, _ALIKE):
            raise TypeError(f"{feature.__name__} has {name}, which nobody calls: it may mean {meant[0]}.")


for _feature in FEATURES:
    check_members(_feature)


def name_of(feature) -> str:
    return feature.__name__.rpartition(".")[2]


#: word -> its position in the order of calls at a hook
ORDER = {name: number for number, name in enumerate(n for f in FEATURES for n in getattr(f, "NAMES", (name_of(f),)))}


def _having(name: str) -> tuple:
    return tuple(getattr(feature, name) for feature in FEATURES if hasattr(feature, name))


PASSES, READ_BACK, MARGINS, CHECKS, DRAWS = (
    _having(name) for name in ("passes", "read_back", "margin", "check", "draws")
)
#: (parts, is_present) of each feature
PARTS = tuple((f.parts, getattr(f, "is_present", lambda planning: True)) for f in FEATURES if hasattr(f, "parts"))


def _joined(attribute: str) -> dict:
    """The tables of all features, joined."""
    return {name: value for feature in FEATURES for name, value in getattr(feature, attribute, {}).items()}


_MODELS = SHADING_MODELS.values()
SAMPLE_VALUES = _joined("SAMPLE_VALUES")
VALUES = SAMPLE_VALUES | _joined("VALUES") | {name: value for model in _MODELS for name, value in model.values.items()}
INPUTS = _joined("INPUTS") | {name: texture for model in _MODELS for name, texture in model.tables.items()}
DRAWN = _joined("DRAWN") | drawing.DRAWN
ARRIVES = drawing.ARRIVES | _joined("ARRIVES")
CONSTANTS = _joined("CONSTANTS") | {
    "SPLATS_PER_ROW": SPLATS_PER_ROW,
    "TEXELS_PER_SPLAT": TEXELS_PER_SPLAT,
    "BLEND_STEPS": BLEND_STEPS,
    "CORNERS_PER_ROW": CORNERS_PER_ROW,
    "TEXELS_PER_CORNER": TEXELS_PER_CORNER,
}
