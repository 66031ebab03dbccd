# SPDX-License-Identifier: GPL-3.0-or-later
"""What settings other than method and samples cost and gain: each is changed alone, beside Balanced with four samples.

They are measured where they matter: levels of detail where splats are small, shadows and bounces of light in lit
scenes, layers among transparent surfaces, and all of them in a scan and a crowd of instances.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial

from bench.trade.cases import CASES, View, crowd
from bench.trade.methods import times
from measuring.report import Table
from measuring.timing import both, in_pairs
from splat_addon.differences import mean_flip
from splat_addon.reference import scenes
from splat_addon.rendering import PRESETS, Light, Renderer, Settings
from splat_addon.trade import ExactPictures, choices_for

_SUN = Light("sun", direction=(0.4, 0.3, -1.0), energy=3.0, casts_shadow=True)
_LIT = {"lights": (_SUN,), "world": (0.3, 0.35, 0.4)}
_BASE = Settings(**{**PRESETS["balanced"].values, "samples": 4}, outputs=("color",))
_FLAT = replace(_BASE, shading="flat")

#: Pictures that the exact ones are made from.
_PICTURES = 32

HEAD = [
    "scene", "setting", "time", "of the least", "FLIP, Gaussian", "FLIP, box", "FLIP beside as set", "surfels drawn",
    "MiB of textures",
]  # fmt: skip


def shots(view: View) -> dict[str, tuple[Callable, Settings]]:
    """Name -> (builds scene and camera, settings)."""

    def lit(scene, camera):
        return replace(scene, **_LIT), camera

    return {
        "sub-pixel sphere": (lambda: CASES["sub-pixel sphere"].build(view), _FLAT),
        "tori in the sun": (lambda: lit(*CASES["torus"].build(view)), _BASE),
        "transparent spheres": (lambda: scenes.transparent_spheres(view.over(1000), size=view.picture), _BASE),
        "scan": (lambda: CASES["scan"].build(view), _FLAT),
        "a crowd of 36": (lambda: lit(*crowd(view, view.over(30_000))), _BASE),
    }


def units(renderer: Renderer, options, report) -> dict[str, Callable[[], list[dict]]]:
    every = shots(View(options.size, options.models))
    names = list(every)[: 1 if options.quick else None]
    return {name: partial(measure, name, *every[name], renderer, options, report) for name in names}


def measure(name: str, build: Callable, settings: Settings, renderer: Renderer, options, report) -> list[dict]:
    """The rows of a scene: the settings as they are, then each number changed."""
    scene, camera = build()
    found = renderer.render(scene, camera, settings).stats["plan"]
    exact = ExactPictures.drawn(renderer, scene, camera, settings, _PICTURES)
    wanted = [choice for choice in choices_for(settings, found) if not choice.series and choice.name != "Preview"]

    def job(choice):
        return partial(renderer.render, scene, camera, choice.of(settings), is_repeatable=True)

    jobs = {choice.name: job(choice) for choice in wanted}
    steps, rows, plain = partial(report.steps, doing=name), [], None
    for setting, pairs in in_pairs(jobs, jobs[wanted[0].name], options.turns, 2 * options.seconds, both, steps):
        frame = pairs.result
        plain = frame.color if plain is None else plain
        flips = {f"flip_{kind}": round(mean_flip(frame.color, color), 4) for kind, color in exact.colors.items()}
        rows.append({
            "scene": name, "setting": setting, **times(pairs, renderer.device), **flips,
            "flip_beside": round(mean_flip(frame.color, plain), 4), "splats": frame.stats["splats_drawn"],
            "bytes": frame.stats["texture_bytes"],
            **{f"converged_{kind}": round(db, 1) for kind, db in exact.converged.items()},
        })  # fmt: skip
    return rows


def made(rows: list[dict]) -> dict[str, Table]:
    about = "Settings changed alone, beside Balanced with four samples; times are in that of the first row of a scene:"
    return {"other settings": Table(about, HEAD, list(_lines(rows)))}


def _lines(rows: list[dict]) -> Iterator[list]:
    named = None
    for row in rows:
        converged = ", ".join(f"{kind} {row[f'converged_{kind}']:.0f} dB" for kind in ("gaussian", "box"))
        scene = "" if row["scene"] == named else f"{row['scene']} (exact pictures good to {converged})"
        named = row["scene"]
        yield [
            scene, row["setting"], f"{row['ratio']:.2f} ± {row['ratio_noise']:.2f}", f"{row['ratio_of_least']:.2f}",
            f"{row['flip_gaussian']:.4f}", f"{row['flip_box']:.4f}", f"{row['flip_beside']:.4f}",
            f"{row['splats']:,}", f"{row['bytes'] / 2**20:.1f}",
        ]  # fmt: skip
