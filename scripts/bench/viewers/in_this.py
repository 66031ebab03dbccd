# SPDX-License-Identifier: GPL-3.0-or-later
"""This project's renderer, with surfels at the same places: "discs" of the same radius, and "surfels", as the operator
makes them of the same samples."""

from __future__ import annotations

import numpy as np
from measured import leave

from splat_addon.rendering import Camera, Renderer, Scene, Settings, open_device
from splat_addon.surfels import Surfels


def prepare(given: dict[str, np.ndarray], kind: str):
    fields = {name.removeprefix(f"{kind}."): values for name, values in given.items() if name.startswith(f"{kind}.")}
    is_solid = bool(fields.pop("is_solid"))
    surfels = Surfels(**fields)
    scene = Scene((surfels.as_solid() if is_solid else surfels,))
    renderer = Renderer(open_device("standalone"))
    settings, size = Settings(shading="flat", transparent_film=True), int(given["size"])

    def draw(view: int) -> np.ndarray:
        camera = Camera.perspective(given["cameras"][view], float(given["angle"]), (size, size), *given["clipping"])
        color = renderer.render(scene, camera, settings).color
        return color[..., :3] + (1 - color[..., 3:]) * given["background"]

    return draw


if __name__ == "__main__":
    leave(prepare)
