# SPDX-License-Identifier: GPL-3.0-or-later
"""SPZ gives the Gaussians that were packed, turned from its axes to those of Blender."""

import gzip

import numpy as np
import pytest

from scan_files.formats import spz_file
from splat_addon.quaternions import quaternion_axes

COUNT = 200
#: From the format's axes, right, up and back, to Blender's, in which z is up.
UP = np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]])


def gaussians():
    random = np.random.default_rng(0)
    quaternions = random.normal(size=(COUNT, 4))
    return random.uniform(-5, 5, (COUNT, 3)), quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)


@pytest.mark.parametrize(("version", "degree", "angle"), [(1, 0, 0.3), (2, 3, 0.3), (3, 1, 0.01)])
def test_gaussians_are_where_and_as_they_were(read, version, degree, angle):
    positions, quaternions = gaussians()
    found = read(spz_file(positions, quaternions, version, degree))
    surfels = found.surfels
    assert found.total == len(surfels) == COUNT and found.view_dependent == (0, 9, 24, 45)[degree]
    step = 0.002 if version == 1 else 1 / 8192 + 1e-6
    assert np.abs(surfels.positions - positions @ UP.T).max() <= step
    # the thinnest axis is the third
    thin = quaternion_axes(quaternions[:, [3, 0, 1, 2]].astype(np.float32))[2] @ UP.T
    assert np.abs(np.einsum("ij,ij->i", surfels.geometric_normals(), thin)).min() > np.cos(angle)
    assert np.allclose(surfels.scales, (2, 2 * np.e), rtol=1e-5)
    display = 0.5 + 0.28209479177387814 * (np.array([128, 166, 89]) / 255 - 0.5) / 0.15
    assert np.allclose(surfels.colors[:, :3], ((display + 0.055) / 1.055) ** 2.4, atol=1e-5)
    assert np.allclose(surfels.colors[:, 3], 0.2)


@pytest.mark.parametrize(
    ("data", "sentence"),
    [
        (spz_file(*gaussians(), 2, count=10**6), "has 1,000,000 Gaussians, but its .* bytes are no whole gzip"),
        (spz_file(*gaussians(), 2, count=2**32 - 1), "has 4,294,967,295 Gaussians"),
        (spz_file(*gaussians(), 2)[:200], "cut off or damaged"),
        (spz_file(*gaussians(), 2)[:-8] + bytes(8), "damaged; copy it again"),  # another checksum
        (gzip.compress(b"NGSP", mtime=0), "ends in its header"),
        (gzip.compress(b"NGSP\x09" + bytes(30), mtime=0), "has version 9"),
        (gzip.compress(b"ply\n", mtime=0), "compressed with gzip; unpack it"),
    ],
)
def test_damage_is_one_sentence(read, data, sentence):
    with pytest.raises(ValueError, match=sentence):
        read(data)
