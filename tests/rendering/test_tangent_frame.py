# SPDX-License-Identifier: GPL-3.0-or-later
"""The frame in which lights with a size are looked up is orthonormal, also seen along the normal."""

import numpy as np

from splat_addon.reference.brdf import tangent_frame, unit
from splat_addon.rendering.device.interface import PipelineDescription
from splat_addon.rendering.plan.composition import FOLDER, compose

FRAGMENT = """
void main() {
  ivec2 at = ivec2(int(gl_FragCoord.x), 0);
  mat3 rows = transpose(tangent_frame(texelFetch(normals, at, 0).xyz, texelFetch(views, at, 0).xyz));
  along = vec4(rows[0], 0.0);
  across = vec4(rows[1], 0.0);
}
"""


def frames_of(device, normals, views) -> np.ndarray:
    """(n, 2, 3) the directions along and across, from the device."""
    description = PipelineDescription(
        name="frames",
        vertex=compose("fullscreen.vert"),
        fragment=(FOLDER / "lib/tangent_frame.glsl").read_text(encoding="utf-8") + FRAGMENT,
        samplers=("normals", "views"),
        outputs=(("vec4", "along"), ("vec4", "across")),
    )
    data = [np.pad(vectors, ((0, 0), (0, 1)))[None].astype(np.float32) for vectors in (normals, views)]
    textures = [device.texture(d.shape[1::-1], "RGBA32F", d) for d in data]
    target = device.target([device.texture((len(normals), 1), "RGBA32F") for _ in range(2)])
    device.draw_fullscreen(device.pipeline(description), target, [], textures)
    drawn = np.stack([target.read(k)[0, :, :3] for k in range(2)], axis=1)
    device.restore()
    return drawn


def test_a_frame_is_orthonormal_whatever_rounding_leaves(on_device):
    """A graphics card's quotients are not rounded as IEEE asks, so that a unit vector's length may be off by a bit."""
    random = np.random.default_rng(5)
    views = unit(random.normal(size=(3000, 3)))
    views[:1500] = 0, 0, 1  # of a parallel camera
    views[:, 2] = np.abs(views[:, 2])
    tilts = random.choice((0.0, 1e-8, 1e-7, 1e-6, 1e-4, 1.0), (3000, 1))
    normals = unit(views + tilts * random.normal(size=(3000, 3))).astype(np.float32)
    normals = (normals * (1 + random.integers(-2, 3, (3000, 1)) * 6e-8)).astype(np.float32)
    views = views.astype(np.float32)
    drawn = on_device(lambda device: frames_of(device, normals, views))
    for frames in (drawn, tangent_frame(normals.astype(float), views.astype(float))[:, :2]):
        both = np.concatenate([frames, normals[:, None]], axis=1)
        np.testing.assert_allclose(both @ np.swapaxes(both, 1, 2), np.broadcast_to(np.eye(3), (3000, 3, 3)), atol=2e-5)
    is_turned = np.linalg.norm(np.cross(normals, views), axis=1) > 1e-4
    truth = tangent_frame(normals.astype(float), views.astype(float))[:, :2]
    assert np.abs(drawn - truth)[is_turned].max() < 0.02
