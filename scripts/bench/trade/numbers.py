# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings other than method and samples cost and gain: each is changed alone, beside Balanced with four samples.

They are measured where they matter: levels of detail where splats are small, shadows and bounces of light in lit
scenes, layers among transparent surfaces, and all of them in a crowd of instances.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import product

import numpy as np

from bench.trade.cases import CASES, View
from splat_addon.differences import mean_flip
from splat_addon.reference import scenes
from splat_addon.rendering import PRESETS, Light, Renderer, Settings
from splat_addon.trade import ExactPictures, choices_for, measure

_SUN = Light("sun", direction=(0.4, 0.3, -1.0), energy=3.0, casts_shadow=True)
_BASE = Settings(**{**PRESETS["balanced"].values, "samples": 4}, outputs=("color",))

#: Instances along each side of the crowd, their distance, and how many times smaller they are than one alone.
_ACROSS, _APART, _SMALLER = 6, 0.5, 5.0

HEAD = [
    "scene", "setting", "time", "least", "FLIP, Gaussian", "FLIP, box", "FLIP beside as set", "surfels drawn",
    "MiB of textures",
]  # fmt: skip


def shots(options):
    """(name, scene, camera, settings)."""
    view = View(options.size, options.models)
    scene, camera = CASES["sub-pixel sphere"].build(view)
    yield "sub-pixel sphere", scene, camera, replace(_BASE, shading="flat")
    if options.quick:
        return
    scene, camera = CASES["torus"].build(view)
    yield "tori in the sun", replace(scene, lights=(_SUN,), world=(0.3, 0.35, 0.4)), camera, _BASE
    scene, camera = scenes.transparent_spheres(view.over(2000), size=view.picture)
    yield "transparent spheres", scene, camera, _BASE
    yield "a crowd of 36", *crowd(view), _BASE


def crowd(view: View):
    """Instances of two tori on a square, in the sun."""
    scene, camera = scenes.torus(view.over(60_000), view.picture)
    places, instances = (np.arange(_ACROSS) - (_ACROSS - 1) / 2) * _APART, []
    for each in scene.surfels:
        for x, y in product(places, places):
            moved = np.diag((1 / _SMALLER, 1 / _SMALLER, 1 / _SMALLER, 1.0)) @ each.matrix_world
            moved[:2, 3] += x, y
            instances.append(replace(each, matrix_world=moved))
    return replace(scene, surfels=tuple(instances), lights=(_SUN,), world=(0.3, 0.35, 0.4)), camera


def number_lines(renderer: Renderer, options) -> Iterator[list]:
    for name, scene, camera, settings in shots(options):
        plan = renderer.render(scene, camera, settings).stats["plan"]
        exact = ExactPictures.drawn(renderer, scene, camera, settings, 32)
        wanted = [choice for choice in choices_for(settings, plan) if not choice.series and choice.name != "Preview"]
        rows = list(measure(renderer, scene, camera, settings, wanted, exact, options.turns))
        converged = ", ".join(f"{kind} {db:.0f} dB" for kind, db in exact.converged.items())
        for row in rows:
            flips = {kind: mean_flip(row.color, color) for kind, color in exact.colors.items()}
            yield [
                f"{name} (exact pictures good to {converged})" if row is rows[0] else "", row.choice.name,
                f"{row.seconds / rows[0].seconds:.2f}", f"{row.least / rows[0].least:.2f}",
                f"{flips['gaussian']:.4f}", f"{flips['box']:.4f}", f"{mean_flip(row.color, rows[0].color):.4f}",
                f"{row.splats:,}", f"{row.bytes / 2**20:.1f}",
            ]  # fmt: skip


def pass_lines(renderer: Renderer, options) -> Iterator[list]:
    """A line for each preset and pass: its share of the time that the passes take together."""
    scene, camera = CASES["torus"].build(View(options.size, options.models))
    scene = replace(scene, lights=(_SUN,), world=(0.3, 0.35, 0.4))
    for preset in PRESETS.values():
        settings = replace(preset.of(_BASE), samples=1, profile=True)
        found: dict[str, list[float]] = {}
        for turn in range(options.turns + 1):
            taken = renderer.render(scene, camera, settings).stats["passes"]
            for name, milliseconds in taken.items() if turn else ():
                found.setdefault(name, []).append(milliseconds)
        whole = sum(float(np.median(each)) for each in found.values())
        shares = sorted(((float(np.median(each)) / whole, name) for name, each in found.items()), reverse=True)
        yield [preset.label, f"{whole:.1f}", ", ".join(f"{name} {share:.0%}" for share, name in shares if share > 0.01)]
