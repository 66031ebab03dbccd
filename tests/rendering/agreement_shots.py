# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes with the settings that they are drawn with, so that their pictures have every line of every shader."""

from splat_addon.rendering import (
    EyeDome,
    Lines,
    Matcap,
    Settings,
)
from splat_addon.rendering.frame import NUMBERED
from splat_addon.rendering.methods import METHODS
from splat_addon.rendering.settings import OUTPUTS
from splat_addon.rendering.shading_models import SHADING_MODELS
from tests.rendering import random_pictures
from tests.rendering.agreement_scenes import MAKERS, environment

BALL = Matcap(environment().pixels)

#: Shading models that show the surface without light.
UNLIT = [model.name for model in SHADING_MODELS.values() if not model.is_lit]

#: Outputs of which samples are added up on the device.
SUMMED = tuple(name for name in OUTPUTS if name not in (*NUMBERED, "position"))

#: scene, method, other settings
CASES = [
    *(("clip_lines", method, {"shading": "flat"}) for method in METHODS),
    *(("textured_plane", method, {}) for method in ("quad", "sprites_unfiltered")),
    *(("polygons", method, {}) for method in ("ewa", "sprites_unfiltered")),
    *(("torus", "mip", {"shading": shading}) for shading in UNLIT if shading not in ("flat", "matcap")),
    ("torus", "mip", {"shading": "matcap", "matcap": BALL}),
    ("torus", "quad", {"shading": "captured", "ambient_occlusion": 1.0}),
    *(("shadows", "quad", {"shading": shading}) for shading in ("phong", "toon", "ramp")),
    ("torus", "mip", {"shading": "flat", "lines": Lines(width=2.0)}),
    ("styles", "mip", {"lines": Lines(width=2.0)}),
    ("styles", "quad", {"lights_splats": True}),
    ("solid_sphere", "quad", {"shading": "flat", "lines": Lines(shallow_angle=0.4)}),
    ("light_linking", "quad", {}),
    ("torus", "quad", {"shading": "flat", "as_printed": True, "edge_threshold": 0.5}),
    ("deep", "quad", {}),
    *(("bent", method, {}) for method in ("mip", "quad", "homogeneous", "sprites_unfiltered")),
    ("folds", "mip", {"sum_format": "float16"}),
    ("own_materials", "mip", {"storage": "16-bit"}),
    ("holdout", "mip", {}),
    *(("finishes", "mip", options) for options in ({"sum_format": "float16"}, {"lights_splats": True})),
    ("sun_apart", "quad", {}),
    *(("cards", "quad", options) for options in ({"storage": "16-bit"}, {"sum_format": "float16"})),
    ("cards", "mip", {"lights_splats": True}),
    *(("transparent_spheres", "mip", {"layers": layers, "blends_rest": layers == 2}) for layers in (2, 8)),
    ("transparent_shadows", "quad", {}),
    ("polygons", "quad", {"ambient_occlusion": 1.0}),
    ("torus", "quad", {"shading": "flat", "eye_dome": EyeDome()}),
    ("mirrored", "quad", {"reflections": True}),
    ("leaves", "quad", {"samples": 2}),
    ("leaves", "mip", {"samples": 2, "outputs": SUMMED}),
    ("glass", "quad", {"refraction": True, "reflections": True}),
    ("glass_shadows", "mip", {"refraction": True}),
    ("finishes", "quad", {"bounces": 1}),
    *(("polygon_shadows", method, {"lights_splats": True}) for method in ("quad", "mip")),
    ("large_lamp_shadows", "quad", {}),
    ("many_finishes", "mip", {}),
    ("normal_maps", "quad", {"shading": "principled"}),
    ("cut_outs", "quad", {"ambient_occlusion": 1.0}),
    ("split", "quad", {}),
    *(("crowd", method, {"outputs": ("color", *NUMBERED)}) for method in ("quad", "mip")),
    ("nothing", "quad", {"outputs": ("color", "depth", "normal")}),
    ("depth_of_field", "quad", {"samples": 3}),
    ("panorama", "mip", {}),
]

#: Random pictures of much at once, for what the others lack: above all further outputs, and layers of everything.
RANDOM = {
    **{f"random {seed}": lambda seed=seed: random_pictures.random_case(seed) for seed in (117, 204, 273)},
    **{f"crowded {seed}": lambda seed=seed: random_pictures.crowded_case(seed) for seed in (16,)},
}


def named(name: str, method: str, options: dict) -> str:
    """What a case is called."""
    return "-".join(
        (
            name,
            method,
            *(
                key if key in ("eye_dome", "lines", "matcap", "outputs") else f"{value}"
                for key, value in options.items()
            ),
        )
    )


USUAL = {"supersampling": 1, "shadow_resolution": 256}
SHOTS = {
    named(*case): lambda case=case: (*MAKERS[case[0]](), Settings(method=case[1], **USUAL | case[2])) for case in CASES
} | RANDOM
