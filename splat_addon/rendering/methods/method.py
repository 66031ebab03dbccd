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

    rasterizer: one of `RASTERIZERS`, of shaders/hosts, which splats are drawn by.
    blurs_rims: its pixel filter blurs where a splat ends; others end sharply.
    filters_silhouettes: a resolve pass filters them as the colours are.
    culls_hidden: splats that lie behind all that is seen are found before they are drawn. The papers draw them, so do
        their methods here.
    sprites_hide: visibility too is of its sprites. Else it is of the exact ellipses.
    writes_depth: at every pixel: the hardware's depth would differ from the one that the method corrects or clamps.
    widens: its quads in space, past the exact ellipses that visibility is of, edge-on by any number of pixels.
    pixel_variance: of its pixel filter, samples squared; 1/12 is that of a box. Textures are looked up under it.
    """

    name: str
    label: str
    paper: str
    summary: str
    rasterizer: str = "screen_space"
    blurs_rims: bool = False
    filters_silhouettes: bool = False
    culls_hidden: bool = False
    sprites_hide: bool = False
    writes_depth: bool = False
    widens: bool = False
    pixel_variance: float = 0.5

    @property
    def spreads(self) -> bool:
        """Whether splats extend past the exact ellipses that the visibility pass draws."""
        return self.widens or self.rasterizer == "screen_space"
