# SPDX-License-Identifier: GPL-3.0-or-later
"""Three presets that are worth their time: each is on the frontier of accuracy and speed (docs/evidence/trade.md)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .settings import Settings


@dataclass(frozen=True)
class Preset:
    """values: the fields of `Settings` that it sets; figures refer to these. samples: number of samples of a final
    render in Blender, enough to make edges as smooth as in the viewport. summary: its purpose and measurements."""

    name: str
    label: str
    summary: str
    values: dict
    samples: int = 1

    @property
    def render_values(self) -> dict:
        """`values`, and what Blender's final render has in addition."""
        return {**self.values, "samples": self.samples}

    def of(self, settings: Settings) -> Settings:
        """`settings` with this preset's values."""
        return replace(settings, **self.values)

    def is_in(self, settings) -> bool:
        """Whether an object with the attributes of `Settings` has this preset's values."""
        return all(getattr(settings, name) == value for name, value in self.render_values.items())


PRESETS = {
    preset.name: preset
    for preset in (
        Preset(
            "preview",
            "Preview",
            "The fastest picture without holes: 19 to 31 dB and FLIP 0.02 to 0.06 from filtered pixels, 21 to 35 dB "
            "from box pixels, in the least time",
            {"method": "quad", "supersampling": 1},
        ),
        Preset(
            "balanced",
            "Balanced",
            "Filtered, so smooth and still in animations and fine textures: 40 to 47 dB and FLIP 0.007 to 0.016 from "
            "filtered pixels, in about 1.6 times the time of Preview a sample. 16 samples smooth creases and polygons",
            {"method": "mip", "supersampling": 1},
            samples=16,
        ),
        Preset(
            "final",
            "Final",
            "The sharpest, for stills and what is scaled down later: 34 to 54 dB and FLIP 0.002 to 0.007 from box "
            "pixels, in about 2.1 times the time of Preview. Set 5 x 5 for detail far below a pixel: 38 dB instead of "
            "34 to 35",
            {"method": "quad", "supersampling": 4},
        ),
    )
}
