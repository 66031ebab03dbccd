# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface shows of itself and of its light: one entry here, one GLSL file and one float64 twin each."""

from . import captured, depth, flat, matcap, normals, overdraw, phong, principled, ramp, toon, weight
from .model import ShadingModel

#: in the order in which users are shown them
SHADING_MODELS = {
    module.MODEL.name: module.MODEL
    for module in (principled, captured, phong, toon, ramp, flat, normals, depth, matcap, overdraw, weight)
}


def get_shading_model(name: str) -> ShadingModel:
    """Raises ValueError for a name that is not registered."""
    if name not in SHADING_MODELS:
        raise ValueError(f"shading must be one of {', '.join(SHADING_MODELS)}, not {name!r}.")
    return SHADING_MODELS[name]
