# SPDX-License-Identifier: GPL-3.0-or-later
"""Open3D's offscreen renderer: unlit squares of one size in pixels. Its pictures are sRGB of 8 bits."""

from __future__ import annotations

import numpy as np
import open3d
from measured import decoded, encoded, leave
from open3d.visualization import rendering


def prepare(given: dict[str, np.ndarray], kind: str):
    size = int(given["size"])
    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(given["positions"].astype(np.float64)))
    # without post-processing colours are written as they are given
    cloud.colors = open3d.utility.Vector3dVector(encoded(given["colors"][:, :3]) / 255.0)
    renderer = rendering.OffscreenRenderer(size, size)
    renderer.scene.view.set_post_processing(False)
    # only the background is decoded first
    grey = float(encoded(encoded(given["background"]) / 255)) / 255
    renderer.scene.set_background((grey, grey, grey, 1.0))
    material = rendering.MaterialRecord()
    material.shader, material.point_size = "defaultUnlit", float(given["pixels"])
    renderer.scene.add_geometry("points", cloud, material)

    def draw(view: int) -> np.ndarray:
        matrix = given["cameras"][view]
        eye, ahead, up = matrix[:3, 3], -matrix[:3, 2], matrix[:3, 1]
        near, far = given["clipping"].tolist()
        projection = rendering.Camera.FovType.Vertical
        renderer.scene.camera.set_projection(np.degrees(float(given["angle"])), 1.0, near, far, projection)
        renderer.scene.camera.look_at(eye + ahead, eye, up)
        return decoded(np.asarray(renderer.render_to_image())[::-1, :, :3])

    return draw


if __name__ == "__main__":
    leave(prepare)
