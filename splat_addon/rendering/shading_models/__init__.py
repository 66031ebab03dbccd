# SPDX-License-Identifier: GPL-3.0-or-later
"""What a surface shows of itself and of its light: one entry here, one GLSL file and one float64 twin each."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class ShadingModel:
    """name: also of shaders/shading_models/<name>.glsl and of its twin in `reference.shading_models`. label: for users.
    source: of the model. summary: what it shows. cost: time of a frame, as a multiple of flat's
        (docs/evidence/features.md).

    is_lit: it looks at lights, with their shadows and the objects they are linked to.
    has_material: it looks at roughness, metallic, reflectance and emission.
    has_world: it looks at the light of the world around.
    tables: textures that its file reads beside the sums. sums: added up for it, and for an output of that name.
    features: (name, why) of what is defined for it alone.
    """

    name: str
    label: str
    source: str
    summary: str
    cost: float
    is_lit: bool = False
    has_material: bool = False
    has_world: bool = False
    tables: tuple[str, ...] = ()
    sums: tuple[str, ...] = ()
    features: tuple[tuple[str, str], ...] = ()

    @property
    def is_diagnostic(self) -> bool:
        """Whether it shows how the picture is made."""
        return bool(self.sums or self.features)


SHADING_MODELS = {
    model.name: model
    for model in (
        ShadingModel(
            "principled",
            "Principled",
            "Walter et al. 2007, Heitz et al. 2016",
            "Diffuse and GGX specular light of the scene's lights and world",
            1.11,
            is_lit=True,
            has_material=True,
            has_world=True,
            tables=("brdf_table",),
        ),
        ShadingModel(
            "phong",
            "Phong",
            "Blinn 1977, normalised",
            "Diffuse light and a highlight as sharp as the material is smooth; lights are points",
            1.06,
            is_lit=True,
            has_material=True,
            has_world=True,
        ),
        ShadingModel(
            "toon",
            "Toon",
            "Lake et al. 2000",
            "Each light in a few even steps, with a highlight that has an edge",
            1.06,
            is_lit=True,
            has_material=True,
            has_world=True,
        ),
        ShadingModel("flat", "Flat", "none needed", "The surfels' own colour, unlit", 1.0),
        ShadingModel(
            "normals",
            "Normals",
            "none needed",
            "The direction that the surface faces in the world, -1 to 1 on each axis as 0 to 1 of red, green and blue",
            1.0,
        ),
        ShadingModel(
            "depth",
            "Depth",
            "none needed",
            "The distance along the view, from black at the nearest to white at the farthest of what is in view",
            1.0,
        ),
        ShadingModel(
            "matcap",
            "Matcap",
            "Sloan et al. 2001",
            "The surfels' own colour, times that of a ball in a picture where it faces the same way",
            1.0,
            tables=("matcap",),
        ),
        ShadingModel(
            "overdraw",
            "Overdraw",
            "none needed",
            "How many splats a sample is the mean of: 1 blue, 4 cyan, 16 green, 64 yellow, 256 and more red",
            1.04,
            sums=("gbuffer_overdraw",),
        ),
        ShadingModel(
            "weight",
            "Weight",
            "none needed",
            "The weights that a sample is the mean by: 1/16 blue, 1/4 cyan, 1 green, 4 yellow, 16 and more red",
            1.0,
            features=(("SUM_OF_WEIGHTS", "the model shows it"),),
        ),
    )
}


def get_shading_model(name: str) -> ShadingModel:
    """Raises ValueError for a name that is not registered."""
    if name not in SHADING_MODELS:
        raise ValueError(f"shading must be one of {', '.join(SHADING_MODELS)}, not {name!r}.")
    return SHADING_MODELS[name]
