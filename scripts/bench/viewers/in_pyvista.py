# SPDX-License-Identifier: GPL-3.0-or-later
"""PyVista: "Gaussian points", whose standard deviation is half the radius; "squares" and "spheres" of one size in
pixels, as viewers of scans draw them. Its pictures are sRGB of 8 bits."""

from __future__ import annotations

import numpy as np
import pyvista
from measured import decoded, encoded, leave


def prepare(given: dict[str, np.ndarray], kind: str):
    size, cloud = int(given["size"]), pyvista.PolyData(given["positions"])
    cloud["colors"] = encoded(given["colors"][:, :3])
    plotter = pyvista.Plotter(off_screen=True, window_size=(size, size), lighting="none")
    plotter.set_background(encoded(np.full(3, given["background"])).tolist())
    plotter.disable_anti_aliasing()
    how = {"scalars": "colors", "rgb": True, "lighting": False}
    if kind == "Gaussian points":
        actor = plotter.add_mesh(cloud, style="points_gaussian", emissive=False, **how)
        actor.mapper.scale_factor = float(given["radius"]) / 2
    else:
        spheres = kind == "spheres"
        plotter.add_mesh(cloud, point_size=float(given["pixels"]), render_points_as_spheres=spheres, **how)
    camera = plotter.camera

    def draw(view: int) -> np.ndarray:
        matrix = given["cameras"][view]
        camera.position, camera.up = matrix[:3, 3], matrix[:3, 1]
        camera.focal_point = matrix[:3, 3] - float(given["distance"]) * matrix[:3, 2]
        camera.view_angle, camera.clipping_range = np.degrees(float(given["angle"])), given["clipping"].tolist()
        plotter.render()
        return decoded(plotter.screenshot(return_img=True)[::-1, :, :3])

    return draw


if __name__ == "__main__":
    leave(prepare)
