# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings that are tried in a scene: those it has, the presets with more and fewer samples, and for what the scene
contains one number at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

from ..rendering import PRESETS, FramePlan, Settings

#: Samples that each way of filtering a pixel is tried with; of the second, along each side of a pixel.
BALANCED_SAMPLES, FINAL_EDGES = (1, 2, 4, 8, 16, 32), (2, 3, 4, 6, 8)


@dataclass(frozen=True)
class Number:
    """A field of `Settings` that trades time for accuracy beside the samples. values: those that are tried. name: of a
    value. rank: sorts values, the closest first. of: the pass of frames in which it matters; "" for all frames."""

    field: str
    values: tuple
    name: Callable[[object], str]
    rank: Callable[[object], float]
    of: str = ""


NUMBERS = (
    Number("detail_tolerance", (0.0, 2.0, 4.0), "Detail Tolerance {:g}".format, lambda pixels: pixels),
    Number("shadow_resolution", (512, 2048), "Shadow Resolution {}".format, lambda texels: -texels, "shadow_maps"),
    Number("layers", (2, 4, 8), "{} Layers".format, lambda count: -count, "peel"),
    Number("storage", ("16-bit",), "Surfel Storage {}".format, lambda name: name != "float32"),
    Number("sum_format", ("float16",), lambda _: "Blend Precision Float 16", lambda name: name != "float32"),
)


@dataclass(frozen=True)
class Choice:
    """name: what a person sees. changes: fields of `Settings` with their values. series: choices of one series differ
    in their number of samples alone. numbers: fields of `NUMBERS` and their values, where it has others than `plain`,
    which is the choice without them."""

    name: str
    changes: dict = field(hash=False)
    series: str = ""
    numbers: tuple = ()
    plain: Choice | None = None

    def of(self, settings: Settings) -> Settings:
        """`settings` with the changes."""
        return replace(settings, **self.changes)

    def with_numbers(self, numbers: dict) -> Choice:
        """This choice with other values of `NUMBERS`. numbers: field -> value."""
        names = (number.name(numbers[number.field]) for number in NUMBERS if number.field in numbers)
        name, changes = ", ".join([self.name, *names]), {**self.changes, **numbers}
        return Choice(name, changes, self.series, tuple(sorted(numbers.items())), self)


def choices_for(settings: Settings, plan: FramePlan) -> list[Choice]:
    """What to try, first the settings as they are, and nothing twice. plan: of a frame, which tells what the scene
    contains."""
    found, seen = [], set()
    for choice in (Choice("As set", {}), *_series(), *_numbers(plan)):
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


def numbers_in(plan: FramePlan) -> list[Number]:
    """Those that matter in frames like this one."""
    passes = {each.name for each in plan.passes}
    return [number for number in NUMBERS if number.of in ("", *passes)]


def _numbers(plan: FramePlan) -> Iterator[Choice]:
    for number in numbers_in(plan):
        for value in number.values:
            yield Choice(number.name(value), {number.field: value})
