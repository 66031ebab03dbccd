# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels that remember their triangle and place take the values of other materials as if sampled with them."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.sampling import Channel, Image, NormalMap, Surface, Texture, TriangleMesh, VertexColors, sample_surface
from splat_addon.sampling.attributes.repainting import Repainting, places_in_triangles
from splat_addon.sampling.mesh.barycentric import barycentric
from splat_addon.sampling.refine.tolerance import Tolerance
from splat_addon.surfels import field_values

SPACING = 0.05


@pytest.fixture(scope="module")
def bumpy() -> TriangleMesh:
    """A folded sheet of 128 triangles with smooth normals, texture coordinates, colours and two materials; its first
    triangle has no area."""
    across, along = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9))
    height = np.sin(2 * across) * np.cos(3 * along)
    positions = np.stack([across, along, height], axis=2).reshape(-1, 3).astype(np.float32)
    first = (np.arange(8)[:, None] * 9 + np.arange(8)).ravel()
    quads = np.stack([first, first + 1, first + 10, first + 9], axis=1)
    triangles = np.concatenate([[[0, 1, 1]], quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).astype(np.int32)
    slopes = np.stack([-2 * np.cos(2 * across) * np.cos(3 * along), 3 * np.sin(2 * across) * np.sin(3 * along)], axis=2)
    normals = np.concatenate([slopes.reshape(-1, 2), np.ones((81, 1))], axis=1)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    at = positions[triangles]
    return TriangleMesh(
        positions,
        triangles,
        corner_normals=normals.astype(np.float32)[triangles],
        corner_uvs=(at[..., :2] + 1) / 2,
        corner_colors=np.concatenate([at * 0.4 + 0.5, np.ones_like(at[..., :1])], axis=2),
        materials=(np.arange(len(triangles)) % 2).astype(np.int32),
        surfaces=(Surface(Channel((0.8, 0.1, 0.1, 1.0))), Surface(Channel((0.1, 0.1, 0.8, 1.0)))),
    )


@pytest.fixture(scope="module")
def other_surfaces() -> tuple[Surface, Surface]:
    """An image of noise with a roughness and a normal map, and vertex colours."""
    random = np.random.default_rng(1)
    picture = Image(np.repeat(np.repeat(random.random((16, 16, 4), np.float32), 4, 0), 4, 1))
    bumps = Image(np.concatenate([random.random((8, 8, 2)), np.ones((8, 8, 2))], axis=2).astype(np.float32))
    bent = NormalMap(Channel((1.0, 1.0, 1.0), Texture(bumps)))
    of_image = Surface(Channel((1.0, 1.0, 1.0, 1.0), Texture(picture)), roughness=_red(picture), normal_map=bent)
    return of_image, Surface(Channel((1.0, 1.0, 1.0, 1.0), VertexColors()))


def _red(picture: Image) -> Channel:
    return Channel((1.0,), Texture(picture, weights=(1.0, 0.0, 0.0, 0.0)))


@pytest.mark.parametrize(
    "options",
    [{"tolerance": None}, {"tolerance": Tolerance(0.0)}, {"tolerance": None, "texture_mapped": True}],
    ids=["even", "large where flat", "texture-mapped"],
)
def test_repainting_equals_sampling_with_the_other_materials(bumpy, other_surfaces, options):
    before = sample_surface(bumpy, spacing=SPACING, crease_angle=None, fits_planes=False, **options)
    other = replace(bumpy, surfaces=other_surfaces)
    after = sample_surface(other, spacing=SPACING, crease_angle=None, fits_planes=False, **options).surfels
    repainting = Repainting(other, SPACING, 1.25, options.get("texture_mapped", False))
    found = _repainted(repainting, before)
    assert len(after) == len(before.surfels) > 1000
    assert {"colors", "materials", "roughness", "normals"} <= found.keys()
    for name in found:
        off = np.abs(found[name] - field_values(after, name)).reshape(len(after), -1).max(axis=1)
        assert np.quantile(off, 0.99) < 2e-3, name
        assert off.max() < 0.05, name


def _repainted(repainting: Repainting, sampling) -> dict[str, np.ndarray]:
    surfels = sampling.surfels
    places = places_in_triangles(repainting.mesh, sampling.triangles, surfels)
    parts = [values for _, values in repainting.blocks(sampling.triangles, places, surfels.arrays())]
    return {name: np.concatenate([part[name] for part in parts]) for name in repainting.fields}


@pytest.mark.parametrize(
    "options",
    [{"tolerance": None}, {"tolerance": Tolerance(0.02)}, {"tolerance": None, "reduction": "three_to_one"}],
    ids=["even", "merged", "on a lattice"],
)
def test_every_surfel_lies_on_its_triangle(bumpy, options):
    sampling = sample_surface(bumpy, spacing=SPACING, **options)
    surfels, triangles = sampling.surfels, sampling.triangles
    assert len(triangles) == len(surfels) and sampling.gaps > 0
    places = surfels.positions + surfels.origin
    shares = barycentric(bumpy, triangles, places)
    nearest = np.einsum("nk,nkc->nc", shares, bumpy.positions[bumpy.triangles[triangles]])
    off = np.linalg.norm(places - nearest, axis=1)
    assert (off < surfels.radius).all()
    assert (surfels.materials == bumpy.materials[triangles]).all()
