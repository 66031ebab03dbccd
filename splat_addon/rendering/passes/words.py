# SPDX-License-Identifier: GPL-3.0-or-later
"""What passes say to the composition of their shaders: the features that are present, and which files are chosen."""

from __future__ import annotations

from collections.abc import Iterable

from ..compose import DEFAULTS, compose
from ..device.interface import PipelineDescription
from ..frame_plan import FramePlan, PlannedPass
from ..methods import get_method
from ..uniforms import blocks_in, constants_in

#: In the order in which they act where several do.
ORDER = (
    "visibility",
    "object_id",
    "straddling",
    "split",
    "transparency",
    "transparent_shadows",
    "holdout",
    "silhouettes",
    "polygons",
    "materials",
    "emission",
    "light_links",
    "shadows",
    "sized_lights",
    "polygon_plane",
    "polygon_material",
    "picture",
    "hiz",
    "textures",
    "gbuffer",
    "oit",
    "depth_in_normals",
    "depth_sum",
    "overdraw",
    "weight_output",
    "shadow_output",
    "lines",
    "edge_threshold",
    "normal_coverage",
    "diffuse_color",
    "emission_output",
    "shadow_overdraw",
)


def pipeline(name, vertex: str, fragment: str, words: Iterable[str], frame: FramePlan, choices=(), constants=(), **state):
    """The description of a pipeline whose shaders are these hosts. choices: beside those of the whole frame."""
    chosen = set(words)
    ordered = (*(word for word in ORDER if word in chosen), *sorted(chosen - set(ORDER)))
    names = {
        **DEFAULTS,
        "method": frame.method,
        "storage": frame.storage,
        "shading": frame.shading,
        "depth_format": "linear" if frame.linear_depth else "hardware",
        "sum_format": frame.accumulation,
        "samples": "mean" if frame.multisamples and not frame.sample_shading else "each",
        "shadow_taps": "masked" if frame.has("SCREEN_DOOR") else "even",
        "polygon_share": "known" if "seen_range" in frame.textures else "compared",
    }
    names = tuple({**names, **dict(choices)}.items())
    texts = [compose(root, ordered, names) for root in (vertex, fragment)]
    both = texts[0] + texts[1]
    return PipelineDescription(
        name=name,
        vertex=texts[0],
        fragment=texts[1],
        blocks=blocks_in(both),
        defines=(*constants_in(both), *constants),
        **state,
    )


def filters(frame: FramePlan) -> tuple[str, ...]:
    return ("silhouettes",) if frame.filters_silhouettes else ()


def kind(planned: PlannedPass) -> str:
    return "layer" if planned.layer else "opaque"


def sum_words(names: tuple[str, ...], planned: PlannedPass) -> tuple[str, ...]:
    """Of a pass that reads or writes these sums."""
    known = {"overdraw_sum": "overdraw", "material_sum": "materials", "light_set_sum": "light_links"}
    words = [word for name, word in known.items() if name in names]
    words.append("depth_sum" if "depth_sum" in names else "depth_in_normals")
    return (*words, kind(planned), *(("emission", "gbuffer_emission") if "emission_sum" in names else ()))


def says_whose(planned: PlannedPass) -> tuple[str, ...]:
    """Whether a pass that draws splats leaves their numbers."""
    numbers = {"identity", "row_identity", "layer_identity", "polygon_identity"}
    return ("object_id",) if numbers & set(planned.writes) else ()


def identity_varyings(planned: PlannedPass) -> tuple[tuple[str, str, str], ...]:
    """What its fragments are told for that."""
    return (("flat", "float", "number"),) if says_whose(planned) else ()


def split(frame: FramePlan) -> tuple[str, ...]:
    return ("split",) if frame.has("SPLIT") else ()


def pixel_variance(frame: FramePlan) -> str:
    """Of what is evaluated once: a sample, or each of its hardware samples, which is a smaller piece of the pixel."""
    return repr(get_method(frame.method).pixel_variance / (frame.multisamples if frame.sample_shading else 1))
