# SPDX-License-Identifier: GPL-3.0-or-later
"""Three settings that are worth their time: each on the frontier of accuracy and speed (docs/trade.md)."""

from __future__ import annotations

from dataclasses import dataclass, replace

from .settings import Settings


@dataclass(frozen=True)
class Preset:
    """values: the fields of `Settings` that it decides. summary: what it is for, and what was measured."""

    name: str
    label: str
    summary: str
    values: dict

    def of(self, settings: Settings) -> Settings:
        """`settings` with this preset's values."""
        return replace(settings, **self.values)

    def is_in(self, settings) -> bool:
        """Whether an object with the attributes of `Settings` has this preset's values."""
        return all(getattr(settings, name) == value for name, value in self.values.items())


_FLOATS = {"storage": "float32", "accumulation": "float32"}

PRESETS = {
    preset.name: preset
    for preset in (
        Preset(
            "preview",
            "Preview",
            "The fastest picture that has no holes",
            {**_FLOATS, "method": "quad", "supersampling": 1},
        ),
        Preset(
            "balanced",
            "Balanced",
            "Filtered: smooth and still, for animations and fine textures",
            {**_FLOATS, "method": "mip", "supersampling": 1},
        ),
        Preset(
            "final",
            "Final",
            "The sharpest, for stills and for what is scaled down later",
            {**_FLOATS, "method": "quad", "supersampling": 4},
        ),
    )
}
