# SPDX-License-Identifier: GPL-3.0-or-later
"""Prints the plan of a scene, or the shaders of one of its passes with the origin of every part.

    python3 -m splat_addon.rendering.plan.compose
    python3 -m splat_addon.rendering.plan.compose attributes --scene splat_addon.reference.scenes:textured_plane \\
        --set method=quad lines=Lines() --variant textured
"""

from __future__ import annotations

import argparse
import ast
from importlib import import_module

import splat_addon.rendering as rendering

from ..settings import Settings
from .build import plan
from .composition import FOLDER
from .frame_plan import FramePlan
from .graph import Pass
from .programs import composed

#: variants of passes that have vertex shaders of their own
VERTEX = {"polygons": "polygon_visibility.vert"}


def main(arguments: list[str] | None = None) -> None:
    options = _parser().parse_args(arguments)
    module, _, function = options.scene.partition(":")
    scene, camera = getattr(import_module(module), function)()
    made = plan(scene, camera, Settings(**{"shadow_resolution": 64, **dict(options.set)}))
    if not options.name:
        print(made)
        return
    found = [p for p in made.passes if p.name == options.name and options.kind in ("", p.kind)]
    if not found:
        names = ", ".join(dict.fromkeys(p.name for p in made.passes))
        raise SystemExit(f"The plan has no pass {options.name} of that kind; its passes are {names}.")
    for p in found:
        print(_shown(made, p, options.variant))


def _shown(made: FramePlan, p: Pass, variants: list[str]) -> str:
    """Both texts of a pass. Raises SystemExit for a variant that it does not have."""
    there = {part.only for part in p.parts} - {"", *made.variants}
    if missing := set(variants) - there:
        raise SystemExit(f"{p.name} has no variant {min(missing)}; it has {', '.join(sorted(there)) or 'none'}.")
    vertex = next((VERTEX[v] for v in variants if v in VERTEX), p.host.vertex)
    if not (FOLDER / "hosts" / f"{vertex}.glsl").exists():
        vertex = "fullscreen.vert"
    texts = composed(made, p, vertex, *(variants or there - set(VERTEX)), origins=True)
    heads = (f"==== {p.name} ({p.kind}): {host}\n" for host in (vertex, p.host))
    return "\n".join(head + text for head, text in zip(heads, texts, strict=True))


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python3 -m splat_addon.rendering.plan.compose",
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("name", nargs="?", help="of a pass; without it the plan is printed")
    parser.add_argument("--kind", default="", help="of passes of that name those of this kind: opaque, layer ...")
    parser.add_argument("--scene", default="splat_addon.reference.scenes:torus", metavar="MODULE:FUNCTION",
                        help="what gives scene and camera")  # fmt: skip
    parser.add_argument("--set", nargs="+", default=[], type=_setting, metavar="NAME=VALUE", help="of `Settings`")
    parser.add_argument("--variant", nargs="+", default=[], help="of its programs: splats, polygons, textured ...")
    return parser


def _setting(text: str) -> tuple[str, object]:
    """A name and its value: a literal, a bare word, or `Lines()`."""
    name, _, value = text.partition("=")
    if value.endswith("()"):
        return name, getattr(rendering, value[:-2])()
    try:
        return name, ast.literal_eval(value)
    except (ValueError, SyntaxError):
        return name, value


if __name__ == "__main__":
    main()
