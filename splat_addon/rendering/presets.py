# SPDX-License-Identifier: GPL-3.0-or-later
"""Three presets that are worth their time: each is on the frontier of accuracy and speed (docs/evidence/trade.md)."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from .scene.eye_dome import EyeDome
from .settings import Settings

#: Fields of `Settings` that show a scan as it was captured, without any light: `Settings(**SCAN_LOOK)`.
SCAN_LOOK = {"shading": "captured", "eye_dome": EyeDome()}


@dataclass(frozen=True)
class Preset:
    """values: the fields of `Settings` that it sets; figures refer to these. samples: number of samples of a final
    render in Blender, enough to make edges as smooth as in the viewport. occludes: whether Blender's pictures have
    ambient occlusion. summary: its purpose and measurements."""

    name: str
    label: str
    summary: str
    values: dict
    samples: int = 1
    occludes: bool = True

    @property
    def render_values(self) -> dict:
        """`values`, and what Blender's final render has in addition."""
        return {**self.values, "samples": self.samples, "use_ambient_occlusion": self.occludes}

    def of(self, settings: Settings) -> Settings:
        """`settings` with this preset's values."""
        return replace(settings, **self.values)

    def is_in(self, settings) -> bool:
        """Whether an object with the attributes of `Settings` has this preset's values."""
        return all(_are_equal(getattr(settings, name), value) for name, value in self.render_values.items())


def _are_equal(one, other) -> bool:
    """Whether two values of a setting are the same. Blender stores its properties' numbers in single precision."""
    return np.float32(one) == np.float32(other) if isinstance(other, float) else one == other


PRESETS = {
    preset.name: preset
    for preset in (
        Preset(
            "preview",
            "Preview",
            "The fastest picture without holes: unfiltered, so edges and textures are jagged",
            {"method": "quad", "supersampling": 1, "detail_tolerance": 1.0},
            occludes=False,
        ),
        Preset(
            "balanced",
            "Balanced",
            (
                "Filtered, so that animations and fine textures are smooth and do not flicker. A sample takes longer "
                "than one of Preview; 16 samples smooth creases and polygons"
            ),
            {"method": "mip", "supersampling": 1, "detail_tolerance": 1.0},
            samples=16,
        ),
        Preset(
            "final",
            "Final",
            (
                "The sharpest, for stills and for pictures that are scaled down later. Takes two to three times as "
                "long as Preview; raise Supersampling to 5 for detail far below a pixel"
            ),
            {"method": "quad", "supersampling": 4, "detail_tolerance": 0.0},
        ),
    )
}
