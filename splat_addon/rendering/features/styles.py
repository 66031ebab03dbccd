# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials that are drawn unlike the rest of the picture (`scene.style`): with ramps and lines of their own.

Each sample sums the moments of its styles' numbers, from which two styles and their shares follow; a table has what
they are.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..passes.decisions import model_in
from ..passes.sums import MAX_STYLES, asked_styles, drawn_lines, material_texels, styles
from ..plan.graph import Part, Texture
from ..plan.hosts import BLENDED, LIT_HOSTS, SPLAT_HOSTS, Host, Kind
from ..scene import Style
from ..scene.lines import Lines

#: Not a sum, because sums may have 16 bits.
MOMENTS = Texture("gbuffer_style", is_multisampled=True)

#: Texels before those of the ramp: colour and width of the lines | weights of luminance, whether there is a ramp |
#: group.
_BEFORE_RAMP = 3


@dataclass(frozen=True, eq=False)
class StyleTable:
    """lines: of the picture. samples: across a pixel."""

    styles: tuple[Style, ...]
    lines: Lines | None
    samples: int

    def texels(self) -> np.ndarray:
        """(styles, 3 + colours, 4) float32: the colours of all ramps at as many even steps as the longest has."""
        longest = max((len(style.ramp.colors) for style in self.styles if style.ramp), default=0)
        found = np.zeros((len(self.styles), _BEFORE_RAMP + longest, 4), np.float32)
        for row, style in zip(found, self.styles, strict=True):
            line = style.line or self.lines
            row[0] = (*line.color, line.width * self.samples) if line else 0
            row[2, 0] = style.group
            if style.ramp:
                row[1] = *style.ramp.luminance, 1
                at, steps = (np.linspace(0, 1, count) for count in (longest, len(style.ramp.colors)))
                row[_BEFORE_RAMP:, :3] = np.transpose([np.interp(at, steps, c) for c in style.ramp.colors.T])
        return found


def table(planning) -> StyleTable:
    return StyleTable(planning.find(styles), planning.settings.lines, planning.settings.supersampling)


INPUTS = {"style_table": lambda tile: tile.resources.kept(tile.plan.find(table), tile.plan.find(table).texels)}
CONSTANTS = {"FIRST_OF_RAMP": _BEFORE_RAMP}


def passes(planning):
    """No passes; records what the frame has."""
    asked, found = planning.find(asked_styles), planning.find(styles)
    if not planning.shown:
        return ()
    if not asked:
        planning.skip("styles", "no material has a ramp or lines of its own")
    elif not found:
        planning.lack("styles", _TOO_MANY.format(len(asked), MAX_STYLES) if len(asked) > MAX_STYLES else _NO_ROOM)
    else:
        planning.has("STYLES", f"{len(found) - 1} beside that of the picture")
        planning.find(table)
        if any(style.ramp for style in found) and not _is_ramped(planning.model):
            planning.skip("ramps of materials", f"{planning.model.name} shading has no use for them")
    return ()


_TOO_MANY = "materials have {} different ramps and lines of their own, and a picture has room for {}: none are drawn"
_NO_ROOM = (
    "materials' own ramps and lines are left out, because pictures with transparency or float16 sums, polygons with "
    "shadows, light linking and different emissions have no room for them; do without one of these"
)


def is_present(planning) -> bool:
    return bool(planning.find(styles))


def _is_ramped(model) -> bool:
    return model.is_lit and model.has_world


def parts(planning, p):
    found, model = planning.find(styles), model_in(planning, p)
    drawn = {"inputs": ("materials",), "constants": planning.find(material_texels).constants}
    looked_up = {"inputs": ("style_table",), "constants": (("STYLES", len(found)),)}
    ramps = ("ramps",) if any(style.ramp for style in found) and _is_ramped(model) else ()
    if p.host in SPLAT_HOSTS and p.kind in BLENDED:
        yield Part("styles", writes=(MOMENTS,), varyings=(("flat", "vec4", "style"),), **drawn)
    has_lines = p.kind == Kind.OPAQUE and planning.find(drawn_lines) is not None
    if p.host in LIT_HOSTS and (ramps or has_lines):
        yield Part("styles", ramps, reads=(MOMENTS,), **looked_up)
    if p.host == Host.LIT_SPLATS and ramps:
        yield Part("styles", ramps, **looked_up)
        yield Part("styles", **drawn)
    if p.host == Host.LINES:
        groups = ("groups",) if len({style.group for style in found}) > 1 else ()
        yield Part("styles", groups, reads=(MOMENTS,), **looked_up)
