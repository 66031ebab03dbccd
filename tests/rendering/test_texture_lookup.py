# SPDX-License-Identifier: GPL-3.0-or-later
"""Texture lookups in GLSL agree with their numpy twin, and the twin with the true mean under the footprint."""

import numpy as np
import pytest

from splat_addon.images import EXTENSIONS, Image
from splat_addon.reference.texture_lookup import texture_colors
from splat_addon.rendering.device.interface import PipelineDescription
from splat_addon.rendering.plan.composition import FOLDER, compose
from splat_addon.rendering.scene import SurfaceTexture
from splat_addon.rendering.upload.atlas import make_atlas

#: The variance of a pixel's Gaussian of sigma 0.7071, in pixels squared.
PIXEL_VARIANCE = 0.5
QUERIES = 400
SIZES = (2, 4, 8, 16, 32, 64)

FRAGMENT = """
void main() {
  ivec2 query = ivec2(int(gl_FragCoord.x) * 2, int(gl_FragCoord.y));
  vec4 place = texelFetch(queries, query, 0), variances = texelFetch(queries, query + ivec2(1, 0), 0);
  color = vec4(texture_color(surface_texture(int(place.z)), place.xy, variances.xyz), 1.0);
}
"""


def random_textures(random):
    """One texture of each extension, two with closest lookup, odd and even sizes, with and without alpha, and an empty
    slot.
    """
    textures = [None]
    for number, extension in enumerate([*EXTENSIONS, "REPEAT", "CLIP"]):
        height, width = random.integers(1, 40, 2)
        pixels = random.uniform(0, 1, (height, width, 4))
        pixels[..., 3] = 1 if number % 2 else random.integers(0, 2, (height, width))
        interpolation = "Closest" if number > 3 else "Linear"
        factor = tuple(random.uniform(0.5, 2, 3))
        textures.append(SurfaceTexture(Image(pixels, extension, interpolation), factor))
    return (*textures, SurfaceTexture(textures[1].image, (1.0, 0.0, 0.5)))


def random_queries(random, slots):
    """Slots, uvs and variances, from strong magnification to a whole texture in a pixel, stretched up to 1000 : 1."""
    size = 10 ** random.uniform(-4, 0.5, (QUERIES, 1, 1))
    turns = [np.linalg.qr(random.normal(size=(QUERIES, 2, 2)))[0] for _ in range(2)]
    stretch = np.stack([np.ones(QUERIES), 10 ** random.uniform(-3, 0, QUERIES)], axis=1)
    footprints = size * turns[0] * stretch[:, None] @ turns[1]
    return random.integers(1, slots, QUERIES), random.uniform(-2.5, 2.5, (QUERIES, 2)), variances_of(footprints)


def variances_of(footprints):
    """The (n, 2, 2) variances of the pixel's Gaussian in uv; a footprint's columns are the steps of uv per pixel along
    x and y.
    """
    return PIXEL_VARIANCE * footprints @ np.swapaxes(footprints, 1, 2)


def gpu_colors(device, atlas, slots, uvs, variances):
    """(n, 3) colours from the device, with one query per pixel."""
    columns = variances[:, (0, 1, 0, 0), (0, 1, 1, 0)]
    data = np.stack([np.column_stack([uvs, slots, slots]), columns], axis=1).reshape(1, -1, 4).astype(np.float32)
    description = PipelineDescription(
        name="lookup",
        vertex=compose("fullscreen.vert"),
        fragment=(FOLDER / "lib/texture_lookup.glsl").read_text(encoding="utf-8") + FRAGMENT,
        samplers=("queries", "texture_atlas", "texture_table"),
        outputs=(("vec4", "color"),),
    )
    textures = [device.texture(d.shape[1::-1], "RGBA32F", d) for d in (data, atlas.texels, atlas.table)]
    target = device.target([device.texture((len(slots), 1), "RGBA32F")])
    device.draw_fullscreen(device.pipeline(description), target, [], textures)
    colors = target.read(0)[0, :, :3]
    device.restore()
    return colors


def test_the_shader_is_its_twin(on_device):
    random = np.random.default_rng(2)
    textures = random_textures(random)
    atlas = make_atlas(textures)
    slots, uvs, variances = random_queries(random, len(textures))
    colors = on_device(lambda device: gpu_colors(device, atlas, slots, uvs, variances))
    twin = np.empty_like(colors)
    for slot in np.unique(slots):
        at = np.flatnonzero(slots == slot)
        twin[at] = texture_colors(atlas, slot, uvs[at].astype(np.float32), variances[at])
    is_smooth = np.array([t is not None and t.image.interpolation == "Linear" for t in textures])[slots]
    # pixels at which nearest texels, or numbers of probes, tie
    differ = np.abs(colors - twin).max(axis=1) > 1e-4
    assert np.count_nonzero(differ[is_smooth]) <= 2
    assert np.count_nonzero(differ) <= QUERIES // 50


@pytest.mark.parametrize("bad", [np.nan, np.inf, 1e30])
def test_a_footprint_without_size_is_the_mean_of_the_texture(bad, on_device):
    pixels = np.random.default_rng(3).uniform(0, 1, (16, 8, 4))
    pixels[..., 3] = 1
    atlas = make_atlas((SurfaceTexture(Image(pixels)),))
    variances = np.full((1, 2, 2), bad)
    colors = on_device(lambda device: gpu_colors(device, atlas, np.zeros(1), np.full((1, 2), 0.3), variances))
    assert np.allclose(colors[0], pixels[..., :3].mean(axis=(0, 1)), atol=5e-4)


def true_mean(pixels, uv, footprint):
    """The mean of the texture under the Gaussian footprint, from 120 x 120 bilinear lookups in numpy (repeated)."""
    t = np.linspace(-3.5, 3.5, 120)
    x, y = (a.ravel() for a in np.meshgrid(t, t))
    weights = np.exp(-(x**2 + y**2) / 2)
    at = uv + np.sqrt(PIXEL_VARIANCE) * np.stack([x, y], axis=1) @ footprint.T
    height, width = pixels.shape[:2]
    position = at * (width, height) - 0.5
    low = np.floor(position).astype(int)
    share = position - low
    total = 0
    for i in (0, 1):
        for j in (0, 1):
            weight = np.where(i, share[:, 0], 1 - share[:, 0]) * np.where(j, share[:, 1], 1 - share[:, 1])
            total = total + weight[:, None] * pixels[(low[:, 1] + j) % height, (low[:, 0] + i) % width]
    return (weights[:, None] * total).sum(axis=0)[:3] / weights.sum()


@pytest.mark.parametrize(("across", "stretch"), [(0.1, 1), (0.5, 1), (1, 1), (3, 1), (0.2, 8), (1, 2), (1, 4), (2, 6)])
def test_a_lookup_is_the_mean_under_the_footprint(across, stretch):
    """The texture has equal contrast at every scale. across: texels per pixel. stretch: ratio of the
    footprint's axes.
    """
    random = np.random.default_rng(4)
    octaves = [np.kron(random.uniform(0, 1, (size, size, 4)), np.ones((64 // size, 64 // size, 1))) for size in SIZES]
    pixels = np.mean(octaves, axis=0)
    pixels[..., 3] = 1
    atlas = make_atlas((SurfaceTexture(Image(pixels)),))
    angles, uvs = random.uniform(0, np.pi, 40), random.uniform(0, 1, (40, 2))
    turn = np.array([[np.cos(angles), -np.sin(angles)], [np.sin(angles), np.cos(angles)]]).transpose(2, 0, 1)
    footprints = turn * (across * stretch / 64, across / 64)
    looked_up = texture_colors(atlas, 0, uvs, variances_of(footprints))
    true = np.array([true_mean(pixels, uv, f) for uv, f in zip(uvs, footprints, strict=True)])
    error = np.sqrt(np.mean((looked_up - true) ** 2))
    assert error < 0.1 * true.std()


def test_an_atlas_that_would_be_too_large_loses_finest_levels():
    pixels = np.random.default_rng(5).uniform(0, 1, (64, 64, 4)).astype(np.float32)
    textures = (SurfaceTexture(Image(pixels)), SurfaceTexture(Image(pixels[:8, :8])))
    atlas = make_atlas(textures, max_texels=3000)
    assert atlas.dropped == 1 and atlas.texels.shape[0] * atlas.texels.shape[1] <= 3000
    x, y, width, height = atlas.table[0, 2].astype(int)
    assert (width, height) == (32, 32) and atlas.table[1, 1, 2] == 8
    halved = (pixels * [1, 1, 1, 1])[..., 3].reshape(32, 2, 32, 2).mean(axis=(1, 3))
    assert np.allclose(atlas.texels[y : y + 32, x : x + 32, 3], halved, atol=1e-3)
