# SPDX-License-Identifier: GPL-3.0-or-later
"""The settings to compare, as a table in which a new axis or value is one line."""

from __future__ import annotations

from dataclasses import replace
from itertools import product

from splat_addon.rendering import Settings
from splat_addon.rendering.methods import METHODS

#: The yardstick: every time is divided by its time.
YARDSTICK = Settings(method="quad", supersampling=1, shading="flat", detail_tolerance=0.0)

#: Settings that a table shows beside method and samples -> abbreviations of their values, the default first.
FORMATS = {
    "multisampling": {0: "", 4: "4 hardware samples"},
    "sample_shading": {False: "", True: "each shaded"},
    "storage": {"float32": "", "16-bit": "16-bit surfels"},
    "sum_format": {"float32": "", "float16": "16-bit sums"},
    "as_printed": {False: "", True: "as printed"},
    "edge_threshold": {0.0: "", 0.25: "threshold 0.25", 1.0: "threshold 1"},
    "layers": {n: f"{n} layers" if n != YARDSTICK.layers else "" for n in (3, 2, 6, 8)},
    "blends_rest": {True: "", False: "the rest lost"},
}


def settings_of(methods: tuple[str, ...], **values) -> list[Settings]:
    """Every method with every combination of the values."""
    combinations = [dict(zip(values, chosen)) for chosen in product(*values.values())]
    return [replace(YARDSTICK, method=method, **values) for method in methods for values in combinations]


EVERY, BOTH = tuple(METHODS), ("quad", "mip")
METHODS_ALONE = settings_of(EVERY) + settings_of(("quad",), supersampling=(2, 4))
#: Samples, hardware samples, thresholds and formats.
FORMATTED = [
    *settings_of(("quad",), supersampling=(1, 2, 3)),
    *settings_of(("quad",), multisampling=(4,), sample_shading=(False, True)),
    *settings_of(("quad",), edge_threshold=(0.25, 1.0)),
    *settings_of(("quad",), multisampling=(4,), edge_threshold=(0.25,)),
    *settings_of(BOTH, storage=("16-bit",)),
    *settings_of(BOTH, sum_format=("float16",)),
    *settings_of(BOTH, storage=("16-bit",), sum_format=("float16",)),
]
#: Layers of transparent surfaces. As many as the deepest place of a scene lose nothing.
LAYERS = [
    YARDSTICK,
    *settings_of(("quad",), supersampling=(2,), layers=(2, 3, 6, 8)),
    *settings_of(("mip",), layers=(2, 3, 6, 8)),
    *settings_of(("mip",), layers=(3, 6), blends_rest=(False,)),
]
#: Hardware samples, shaded once and each, beside as many of the picture's own, and EWA, whose place they take; the
#: filters as printed.
OF_PAPERS = [
    YARDSTICK,
    *settings_of(("quad",), supersampling=(2,)),
    *settings_of(("quad",), multisampling=(4,), sample_shading=(False, True)),
    *settings_of(("ewa", "ewa_object"), as_printed=(False, True)),
    *settings_of(("mip", "raycast", "raycast_printed", "sprites", "sprites_printed")),
]
#: What the page compares.
OF_PAGE = [
    *METHODS_ALONE,
    *settings_of(("mip",), supersampling=(2,)),
    *settings_of(("quad",), multisampling=(4,), sample_shading=(False, True)),
    *settings_of(("ewa", "ewa_object"), as_printed=(True,)),
]
ALL = list(dict.fromkeys([*OF_PAGE, *FORMATTED]))
CHOICES = {
    "page": OF_PAGE, "methods": METHODS_ALONE, "formats": FORMATTED, "all": ALL, "layers": LAYERS, "papers": OF_PAPERS
}  # fmt: skip

#: The choices shown beside the reference.
PICTURED = frozenset([*settings_of(("mip", "ewa", "raycast")), replace(YARDSTICK, supersampling=2)])


def choices(name: str = "all", multisample_counts: tuple[int, ...] = ()) -> list[Settings]:
    """The entries of `CHOICES` that the device's sample counts allow, including the yardstick."""
    return [settings for settings in CHOICES[name] if settings.multisampling in (0, *multisample_counts)]


def of_case(case, name: str, multisample_counts: tuple[int, ...]) -> list[Settings]:
    """What a scene is drawn with. For the page the promised scenes have all methods and samples, others the methods
    alone, and both what the scene names."""
    names = (name,) if name != "page" else ("page" if case.is_promised else "methods", case.more)
    found = [settings for each in filter(None, names) for settings in choices(each, multisample_counts)]
    return list(dict.fromkeys(found))


def columns(settings: Settings) -> dict:
    """The settings that distinguish choices, as the table shows them."""
    return {
        "method": settings.method,
        "samples": f"{settings.supersampling} x {settings.supersampling}",
        **{name: getattr(settings, name) for name in FORMATS},
    }


def label(settings: Settings) -> str:
    """Label for plots; differences from float32 are named."""
    formats = [names[getattr(settings, name)] for name, names in FORMATS.items()]
    samples = f"{settings.supersampling} x {settings.supersampling}"
    return ", ".join([METHODS[settings.method].label, samples, *filter(None, formats)])
