# SPDX-License-Identifier: GPL-3.0-or-later
"""The ways to rasterise and filter a splat: one registry entry, one GLSL file and one numpy twin each."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

from . import affine, ewa, homogeneous, mip, quad, raycast


@dataclass(frozen=True)
class Method:
    """name: also of shaders/methods/<name>.glsl. paper: its source. summary: what it gains and costs, for users.

    works_in: "space" (quads that the hardware clips, interpolates and hides) or "picture" (a rectangle around each
        footprint, every pixel computed).
    visibility_samples: along each side of a sample, of the visibility pass; above 1 splats are hidden by shares,
        and coverage is filtered as the colours are.
    twin: the same functions in numpy.
    """

    name: str
    paper: str
    summary: str
    twin: ModuleType
    works_in: str = "picture"
    visibility_samples: int = 1


METHODS = {
    method.name: method
    for method in (
        Method(
            "mip",
            "this project, after Zwicker et al. 2001",
            "Filters every splat for the pixel in its own plane: smooth at one sample a pixel",
            mip,
            visibility_samples=2,
        ),
        Method(
            "quad",
            "View-independent object-space surface splatting, section 4",
            "No filter: the fastest, and with many samples the sharpest",
            quad,
            works_in="space",
        ),
        Method("ewa", "Zwicker et al. 2001, Ren et al. 2002", "Affine filter in the picture: the classic", ewa),
        Method("raycast", "Botsch et al. 2005, sections 3 and 5", "Ray cast, or a disc of the pixel's size", raycast),
        Method(
            "homogeneous",
            "Guennebaud et al. 2006, section 3",
            "Small splats are enlarged to the pixel's size",
            homogeneous,
        ),
        Method("affine", "Botsch and Kobbelt 2003, section 4", "Point sprites: discs, holes at flat angles", affine),
    )
}


def get_method(name: str) -> Method:
    """Raises ValueError for a name that is not registered."""
    if name not in METHODS:
        raise ValueError(f"A method is one of {', '.join(METHODS)}, not {name!r}.")
    return METHODS[name]
