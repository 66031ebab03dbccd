# SPDX-License-Identifier: GPL-3.0-or-later
"""The Gaussians of glTF files are read as KHR_gaussian_splatting says, plain or as SPZ."""

import base64
import json

import numpy as np
import pytest

from scan_files.formats import glb_file, gltf_of_gaussians, spz_file
from splat_addon.interchange import read_contents
from splat_addon.interchange.gaussians import SH_DEGREE_0
from splat_addon.quaternions import quaternion_axes

COUNT = 40


def gaussians():
    """Positions, sizes of flat discs, quaternions x y z w, opacities, harmonics."""
    random = np.random.default_rng(0)
    sizes = random.uniform(0.1, 0.4, (COUNT, 3))
    sizes[np.arange(COUNT), np.arange(COUNT) % 3] = 0.001
    turns = random.normal(size=(COUNT, 4))
    turns /= np.linalg.norm(turns, axis=1, keepdims=True)
    arrays = (
        random.normal(size=(COUNT, 3)),
        sizes,
        turns,
        random.uniform(0.1, 1, (COUNT, 1)),
        random.normal(size=(COUNT, 3)),
    )
    return [array.astype("<f4") for array in arrays]


def turned(vectors):
    """From y up to z up."""
    return np.stack([vectors[:, 0], -vectors[:, 2], vectors[:, 1]], axis=1)


def axis_of(turns, which):
    """(N, 3) the images of the axes with these numbers."""
    axes = np.stack(quaternion_axes(turns[:, [3, 0, 1, 2]].astype(np.float64)), axis=1)
    return axes[np.arange(len(turns)), which]


def read(path, data):
    path.write_bytes(data)
    return read_contents(path)


@pytest.mark.parametrize("is_binary", [True, False])
@pytest.mark.parametrize("node", [{}, {"translation": [1, 2, 3]}, {"rotation": [0, 0, 0.6, 0.8], "scale": [2, 2, 2]}])
def test_gaussians_are_discs_in_the_scene(is_binary, node, tmp_path):
    positions, sizes, turns, opacities, harmonics = gaussians()
    description, data = gltf_of_gaussians(positions, sizes, turns, opacities, harmonics)
    description["nodes"][0] |= node
    if not is_binary:
        description["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    file = glb_file(description, data) if is_binary else json.dumps(description).encode()
    found = read(tmp_path / "splats", file)
    scale = node.get("scale", [1])[0]
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    turn = np.stack(quaternion_axes(np.array([[w, x, y, z]], float)), axis=2)[0]
    places = turned(scale * positions @ turn.T + node.get("translation", (0, 0, 0)))
    surfels = found.surfels
    assert found.total == len(surfels) == COUNT
    assert np.allclose(surfels.positions + surfels.origin, places, atol=1e-5)
    normals = turned(axis_of(turns, np.arange(COUNT) % 3) @ turn.T)
    assert np.abs(np.einsum("ij,ij->i", surfels.geometric_normals(), normals)).min() > 1 - 1e-5
    wide = np.sort(sizes, axis=1)[:, 1:]
    assert np.allclose(np.sort(surfels.scales, axis=1), 2 * scale * wide, rtol=1e-4)
    assert np.allclose(surfels.colors[:, 3], opacities[:, 0])
    display = np.maximum(0.5 + SH_DEGREE_0 * harmonics, 0)
    assert np.allclose(
        surfels.colors[:, :3],
        np.where(display > 0.04045, ((display + 0.055) / 1.055) ** 2.4, display / 12.92),
        atol=1e-5,
    )


def test_linear_colors_and_integers_are_told_apart(tmp_path):
    positions, sizes, turns, opacities, harmonics = gaussians()
    bytes_of = np.rint(255 * opacities).astype("u1")
    description, data = gltf_of_gaussians(positions, sizes, turns, bytes_of, harmonics)
    description["meshes"][0]["primitives"][0]["extensions"]["KHR_gaussian_splatting"]["colorSpace"] = (
        "lin_rec709_display"
    )
    surfels = read(tmp_path / "splats", glb_file(description, data)).surfels
    assert np.allclose(surfels.colors[:, :3], np.maximum(0.5 + SH_DEGREE_0 * harmonics, 0), atol=1e-5)
    assert np.allclose(surfels.colors[:, 3], bytes_of[:, 0] / 255)


def test_spz_inside_is_spz(tmp_path):
    positions, _, turns, _, _ = gaussians()
    packed = spz_file(positions, turns.astype(np.float64), 2, 0)
    primitive = {"attributes": {}, "mode": 0, "extensions": {"KHR_gaussian_splatting": {"extensions": {
        "KHR_gaussian_splatting_compression_spz_2": {"bufferView": 0}}}}}  # fmt: skip
    description = {
        "asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [primitive]}], "buffers": [{"byteLength": len(packed)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(packed)}],
    }  # fmt: skip
    found, alone = read(tmp_path / "splats", glb_file(description, packed)), read(tmp_path / "alone", packed)
    assert found.total == alone.total == COUNT and found.said == alone.said
    assert np.array_equal(found.surfels.positions, alone.surfels.positions)


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        (lambda d: d["accessors"][0].update(count=10**12), "outside its view"),
        (lambda d: d["accessors"][0].update(count="many"), "in another form"),
        (lambda d: d["bufferViews"][0].update(byteLength=10**9), "outside its buffer"),
        (lambda d: d["nodes"][0].update(children=[0]), "parents"),
        (lambda d: d["meshes"][0]["primitives"][0]["extensions"].clear(), "shows no Gaussian splats"),
        (lambda d: d["meshes"][0]["primitives"][0]["attributes"].pop("POSITION"), "have no POSITION"),
        (lambda d: d["accessors"][1].pop("componentType"), "lacks something"),
        (lambda d: d["buffers"][0].update(uri="../secret.bin"), "not beside it"),
        (lambda d: d["buffers"][0].update(uri="none.bin"), "cannot be read"),
    ],
)
def test_what_is_wrong_is_a_sentence(change, sentence, tmp_path):
    description, data = gltf_of_gaussians(*gaussians())
    change(description)
    with pytest.raises(ValueError, match=sentence):
        read(tmp_path / "splats", glb_file(description, data))
