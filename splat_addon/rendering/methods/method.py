# SPDX-License-Identifier: GPL-3.0-or-later
"""A registry entry for a method."""

from __future__ import annotations

from dataclasses import dataclass

#: name -> what it draws of each splat
RASTERIZERS = {
    "object_space": "what the hardware clips, interpolates and hides",
    "screen_space": "a triangle around each footprint, of which every pixel is computed",
    "point_sprite": "a square parallel to the picture; the nearest wins, in one pass, and nothing blends",
}


@dataclass(frozen=True)
class Method:
    """name: also of shaders/methods/<name>.glsl. label: for users. paper: its source.
    summary: what it gains and costs.

    rasterizer: how splats are drawn, a name in `RASTERIZERS`; its shaders are in shaders/hosts.
    blurs_rims: the pixel filter blurs the rims of splats; without it they end sharply.
    filters_silhouettes: a resolve pass filters silhouettes in the same way as colours.
    culls_hidden: splats behind everything that is seen are found before they are drawn. The papers draw them, and so
        do their methods here.
    hides_within: what the visibility pass draws of each splat, if not the exact ellipse: its "sprite", or what lies in
        the paper's "square" around it.
    writes_depth: the shader writes the depth of every pixel, because the hardware's would differ from the one that the
        method corrects or clamps.
    widens: quads extend in space past the exact ellipses that the visibility pass draws; for splats seen edge-on, by
        any number of pixels.
    seems_nearer: radii by which what the pixel filter shows beside a splat that is seen edge-on may seem nearer than
        the splat is.
    varyings: (how it is interpolated, type, name) of what it sets up once a splat for its fragments.
    pixel_variance: variance of the pixel filter, samples squared; a box has 1/12. None: the settings choose it.
        Textures are looked up under it.
    printed_variance: the paper's, where the settings choose it.
    """

    name: str
    label: str
    paper: str
    summary: str
    rasterizer: str = "screen_space"
    blurs_rims: bool = False
    filters_silhouettes: bool = False
    culls_hidden: bool = False
    hides_within: str = ""
    writes_depth: bool = False
    widens: bool = False
    seems_nearer: float = 2.0
    varyings: tuple[tuple[str, str, str], ...] = ()
    pixel_variance: float | None = None
    printed_variance: float | None = None

    @property
    def spreads(self) -> bool:
        """Whether splats extend past the exact ellipses that the visibility pass draws."""
        return self.widens or self.rasterizer == "screen_space"
