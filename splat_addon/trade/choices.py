# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that are tried in a scene: those it has, the presets with more and fewer samples, and for what the scene
contains one number at a time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

from ..rendering import PRESETS, FramePlan, Settings

#: Samples that each way of filtering a pixel is tried with; of the second, along each side of a pixel.
BALANCED_SAMPLES, FINAL_EDGES = (1, 2, 4, 8, 16, 32), (2, 3, 4, 6, 8)

#: The values of a number that are tried, if it has another.
TOLERANCES, SHADOW_RESOLUTIONS, LAYERS = (0.0, 2.0, 4.0), (512, 2048), (2, 4, 8)


@dataclass(frozen=True)
class Choice:
    """name: what a person sees. changes: fields of `Settings` with their values. series: choices of one series differ
    in their number of samples alone."""

    name: str
    changes: dict = field(hash=False)
    series: str = ""

    def of(self, settings: Settings) -> Settings:
        """`settings` with the changes."""
        return replace(settings, **self.changes)


def choices_for(settings: Settings, plan: FramePlan) -> list[Choice]:
    """What to try, first the settings as they are, and nothing twice. plan: of a frame, which tells what the scene
    contains."""
    found, seen = [], set()
    for choice in (Choice("As set", {}), *_series(), *_numbers(settings, plan)):
        made = choice.of(settings)
        if made not in seen:
            seen.add(made)
            found.append(choice)
    return found


def series_of() -> list[Choice]:
    """The two ways of filtering a pixel, each with more and fewer samples."""
    return list(_series())


def quick_choices() -> list[Choice]:
    """A few of `series_of`, between which and beyond which others can be expected."""
    return [choice for choice in _series() if choice.name in _QUICK]


#: The names of those that the first picture of a render is measured with.
_QUICK = ("Preview", "Balanced, 1 sample", "Balanced, 4 samples", "Final, 2 x 2", "Final, 4 x 4")


def _series() -> Iterator[Choice]:
    preview, balanced, final = (PRESETS[name] for name in ("preview", "balanced", "final"))
    yield Choice(preview.label, {**preview.values, "samples": 1})
    for samples in BALANCED_SAMPLES:
        yield with_samples(balanced.label, balanced.values, samples)
    for edge in FINAL_EDGES:
        yield with_samples(final.label, {**final.values, "samples": 1}, edge)


def with_samples(series: str, values: dict, number: int) -> Choice:
    """A choice of a series. values: with a supersampling above 1 if `number` is along each side of a pixel."""
    if values["supersampling"] > 1:
        return Choice(f"{series}, {number} x {number}", {**values, "supersampling": number}, series)
    counted = "1 sample" if number == 1 else f"{number} samples"
    return Choice(f"{series}, {counted}", {**values, "samples": number}, series)


def _numbers(settings: Settings, plan: FramePlan) -> Iterator[Choice]:
    for tolerance in TOLERANCES:
        yield Choice(f"Detail Tolerance {tolerance:g}", {"detail_tolerance": tolerance})
    passes = {each.name for each in plan.passes}
    if "shadow_maps" in passes:
        for texels in SHADOW_RESOLUTIONS:
            yield Choice(f"Shadow Resolution {texels}", {"shadow_resolution": texels})
    if "peel" in passes:
        for layers in LAYERS:
            yield Choice(f"{layers} Layers", {"layers": layers})
    yield Choice("Surfel Storage 16-bit", {"storage": "16-bit"})
    yield Choice("Blend Precision Float 16", {"sum_format": "float16"})
