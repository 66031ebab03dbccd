# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways to rasterise and filter a splat: one registry entry, one GLSL file and one numpy twin
(reference/methods) each."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Method:
    """name: also of shaders/methods/<name>.glsl. label: for users. paper: its source.
    summary: what it gains and costs.

    works_in: "space" (what the hardware clips, interpolates and hides), "picture" (a triangle around each footprint,
        every pixel computed) or "sprites" (parallel to the picture; the nearest wins, in one pass, and nothing blends).
    blurs_rims: its pixel filter blurs where a splat ends; others end sharply.
    filters_silhouettes: a resolve pass filters them as the colours are.
    culls_hidden: splats that lie behind all that is seen are found before they are drawn. The papers draw them, so do
        their methods here.
    sprites_hide: visibility too is of its sprites. Else it is of the exact ellipses.
    writes_depth: at every pixel: the hardware's would be another than that which it corrects or clamps.
    pixel_variance: of its pixel filter, samples squared; 1/12 is that of a box. Textures are looked up under it.
    """

    name: str
    label: str
    paper: str
    summary: str
    works_in: str = "picture"
    blurs_rims: bool = False
    filters_silhouettes: bool = False
    culls_hidden: bool = False
    sprites_hide: bool = False
    writes_depth: bool = False
    pixel_variance: float = 0.5


METHODS = {
    method.name: method
    for method in (
        Method(
            "mip",
            "Mip Filter",
            "this project, after Zwicker et al. 2001",
            "Smooth and still at one sample a pixel: 40 to 47 dB in 1.3 to 1.9 times the time of Quads",
            blurs_rims=True,
            filters_silhouettes=True,
            culls_hidden=True,
        ),
        Method(
            "quad",
            "Quads",
            "View-independent object-space surface splatting, sections 4.1 to 4.3",
            "No filter: the fastest, and with many samples the sharpest",
            works_in="space",
            pixel_variance=1 / 12,
        ),
        Method(
            "ewa",
            "EWA",
            "Zwicker et al. 2001, Ren et al. 2002",
            "The classic filter, in the picture; blurs silhouettes",
            blurs_rims=True,
        ),
        Method(
            "ewa_object",
            "EWA in Space",
            "Ren et al. 2002; view-independent object-space surface splatting, section 3, equation 10",
            "The same filter joined in each splat's plane, drawn as a larger quad",
            works_in="space",
            writes_depth=True,
        ),
        Method(
            "raycast",
            "Ray Cast",
            "Botsch et al. 2005, sections 3 and 5",
            "Exact ellipses, no smaller than the pixel's disc",
        ),
        Method(
            "raycast_printed",
            "Ray Cast, as Printed",
            "Botsch et al. 2005, sections 3 and 5, within the paper's square",
            "The square cuts the low-pass, and large splats off the axis",
        ),
        Method(
            "homogeneous",
            "Homogeneous",
            "Guennebaud et al. 2006, sections 3 and 4, repaired",
            "Exact ellipses no smaller than the pixel's filter, at their planes' depth; 3 dB truer at flat angles",
        ),
        Method(
            "homogeneous_printed",
            "Homogeneous, as Printed",
            "Guennebaud et al. 2006, sections 3 and 4, equations 8 to 10",
            "The paper's own formulas: a disc that faces the ray vanishes, small ones lose their depth",
        ),
        Method(
            "sprites",
            "Sprites",
            "Botsch and Kobbelt 2003, sections 3.1 to 3.4",
            "Discs in point sprites; opens holes at flat angles",
            sprites_hide=True,
            writes_depth=True,
            pixel_variance=1 / 12,
        ),
        Method(
            "sprites_printed",
            "Sprites, as Printed",
            "Botsch and Kobbelt 2003, equation 4 as printed",
            "The paper's own formula: depths are off by as much as splats are flatter or steeper than 1 unit",
            sprites_hide=True,
            writes_depth=True,
            pixel_variance=1 / 12,
        ),
        Method(
            "sprites_unfiltered",
            "Sprites, Unfiltered",
            "Botsch and Kobbelt 2003, sections 3.1 and 3.2",
            "Discs in point sprites of which the nearest is seen: nothing blends, 0.65 to 0.7 of the time of Quads",
            works_in="sprites",
            pixel_variance=1 / 12,
        ),
    )
}


def get_method(name: str) -> Method:
    """Raises ValueError for a name that is not registered."""
    if name not in METHODS:
        raise ValueError(f"A method is one of {', '.join(METHODS)}, not {name!r}.")
    return METHODS[name]
