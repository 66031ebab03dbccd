# SPDX-License-Identifier: GPL-3.0-or-later
"""How it is drawn: a table of settings, in which a new axis or value is one line."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

from splat_addon.rendering import Settings
from splat_addon.rendering.methods import METHODS

#: Methods that take a splat's own kernel at a sample, without the pixel's filter.
UNFILTERED = frozenset({"quad", "affine_unfiltered"})

#: What every time is divided by.
YARDSTICK = Settings(method="quad", supersampling=1, shading="flat")

#: Settings that a table shows beside method and samples -> their names in a few letters, the usual one's first.
FORMATS = {
    "multisampling": {0: "", 4: "4 hardware samples"},
    "sample_shading": {False: "", True: "each shaded"},
    "storage": {"float32": "", "16-bit": "16-bit surfels"},
    "accumulation": {"float32": "", "float16": "16-bit sums"},
}

EVERY = tuple(METHODS)


@dataclass(frozen=True)
class Line:
    """Every method with every combination of the values. is_quick: also of a quick run."""

    methods: tuple[str, ...]
    values: dict
    is_quick: bool = False

    def settings(self) -> list[Settings]:
        combinations = [dict(zip(self.values, values, strict=True)) for values in product(*self.values.values())]
        return [replace(YARDSTICK, method=method, **values) for method in self.methods for values in combinations]


LINES = (
    Line(EVERY, {"supersampling": (1,)}, is_quick=True),
    Line(("quad",), {"supersampling": (2, 4)}, is_quick=True),
    Line(("quad",), {"supersampling": (3,)}),
    Line(("mip",), {"supersampling": (2,)}),
    Line(("quad", "mip"), {"supersampling": (1,), "accumulation": ("float16",)}),
    Line(("quad", "mip"), {"supersampling": (1,), "storage": ("16-bit",)}),
    Line(("quad",), {"supersampling": (1,), "multisampling": (4,), "sample_shading": (False, True)}),
)

#: What is shown beside the truth.
PICTURED = frozenset([*Line(EVERY, {"supersampling": (1,)}).settings(), replace(YARDSTICK, supersampling=2)])


def choices(quick: bool = False, multisample_counts: tuple[int, ...] = ()) -> list[Settings]:
    """Each setting of the lines that the device can draw, once; the yardstick is among them.

    multisample_counts: of the device.
    """
    every = dict.fromkeys(settings for line in LINES if line.is_quick or not quick for settings in line.settings())
    return [settings for settings in every if settings.multisampling in (0, *multisample_counts)]


def columns(settings: Settings) -> dict:
    """The settings that tell choices apart, as the table shows them."""
    return {
        "method": settings.method,
        "prefilter": "none" if settings.method in UNFILTERED else "pixel",
        "samples": f"{settings.supersampling} x {settings.supersampling}",
        **{name: getattr(settings, name) for name in FORMATS},
    }


def label(settings: Settings) -> str:
    """For plots: what differs from float32 is named."""
    formats = [names[getattr(settings, name)] for name, names in FORMATS.items()]
    samples = f"{settings.supersampling} x {settings.supersampling}"
    return ", ".join([METHODS[settings.method].label, samples, *filter(None, formats)])
