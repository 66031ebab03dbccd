# SPDX-License-Identifier: GPL-3.0-or-later
"""A small scene of surfels, rendered by the engine as a user would, and its picture read back from the file."""

import bpy
import numpy as np
import pytest

from splat_addon.blender.geometry.attributes import write_surfels
from splat_addon.blender.geometry.points_proxy import show_as_points
from splat_addon.quaternions import axes_quaternions
from splat_addon.rendering.scene import polygons
from splat_addon.rendering.upload import resources, storages
from splat_addon.surfels import Surfels

IMAGE_FORMATS = {"OPEN_EXR": "IMAGE", "OPEN_EXR_MULTILAYER": "MULTI_LAYER_IMAGE"}


@pytest.fixture
def scene(empty_file, tmp_path):
    """An empty scene for our engine: 32 x 32 pixels, one unfiltered sample, no lighting, occlusion or reflections,
    transparent film, float file.
    """
    made = bpy.context.scene
    made.render.engine = "SURFEL_SPLATTING"
    made.render.resolution_x = made.render.resolution_y = 32
    made.render.film_transparent = True
    made.surfel_splatting.shading = "flat"
    made.surfel_splatting.use_ambient_occlusion = made.surfel_splatting.use_reflections = False
    made.surfel_splatting.method, made.surfel_splatting.supersampling = "quad", 1
    made.surfel_splatting.samples = made.surfel_splatting.blur_samples = 1
    # Unless told otherwise, a render in background stops at an object that it cannot draw.
    made.surfel_splatting.broken_objects = "WARN"
    made.render.filepath = str(tmp_path / "picture.exr")
    set_format(made.render, "OPEN_EXR")
    return made


def set_format(render: bpy.types.RenderSettings, file_format: str) -> None:
    """Write float files with alpha. From Blender 5.0 on, the type of media must be set first."""
    if hasattr(render.image_settings, "media_type"):
        render.image_settings.media_type = IMAGE_FORMATS[file_format]
    render.image_settings.file_format = file_format
    render.image_settings.color_depth = "32"
    if file_format == "OPEN_EXR":
        render.image_settings.color_mode = "RGBA"


@pytest.fixture
def add_camera(scene):
    """add_camera(location, rotation, **data properties) -> the scene's camera; without a rotation it looks down."""

    def add(location=(0, 0, 10), rotation=(0, 0, 0), **properties) -> bpy.types.Object:
        data = bpy.data.cameras.new("camera")
        for name, value in properties.items():
            setattr(data, name, value)
        camera = bpy.data.objects.new("camera", data)
        camera.location, camera.rotation_euler = location, rotation
        scene.collection.objects.link(camera)
        scene.camera = camera
        return camera

    return add


@pytest.fixture
def add_surfels(add_object):
    """add_surfels(positions, normals, size, colors) -> an object of surfels; one normal, size or colour may serve all.

    is_shown: whether the object gets the modifier that shows converted objects as points.
    """

    def add(
        positions, normals=(0, 0, 1), size=0.1, colors=(1, 1, 1, 1), name="surfels", is_shown=True
    ) -> bpy.types.Object:
        made = add_object(write_surfels(name, make_surfels(positions, normals, size, colors)))
        if is_shown:
            show_as_points(made)
        return made

    return add


def make_surfels(positions, normals, size, colors) -> Surfels:
    """positions: (N, 3). normals: (N, 3) or (3,). size: half-axes, (N, 2) or one number. colors: (N, 4) or (4,)."""
    positions = np.atleast_2d(np.asarray(positions, np.float64))
    count = len(positions)
    z = np.broadcast_to(np.asarray(normals, np.float64), (count, 3))
    z = z / np.linalg.norm(z, axis=1, keepdims=True)
    x = np.cross(np.where(np.abs(z[:, :1]) < 0.9, (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), z)
    x /= np.linalg.norm(x, axis=1, keepdims=True)
    return Surfels(
        positions=positions,
        rotations=axes_quaternions(x, np.cross(z, x), z),
        scales=np.broadcast_to(size, (count, 2)),
        normals=z,
        colors=np.broadcast_to(colors, (count, 4)),
        materials=np.zeros(count),
    )


@pytest.fixture
def add_sheet(add_surfels):
    """add_sheet(side, count) -> count x count surfels over a square of that side around the origin, facing up."""

    def add(side=2.0, count=40, **options) -> bpy.types.Object:
        axis = (np.arange(count) + 0.5) * side / count - side / 2
        x, y = (a.ravel() for a in np.meshgrid(axis, axis))
        return add_surfels(np.stack([x, y, 0 * x], axis=1), size=1.5 * side / count, **options)

    return add


@pytest.fixture
def saved_image(tmp_path):
    """saved_image(name, color) -> the path of a PNG file of 4 x 2 pixels of that colour, as encoded."""

    def save(name, color) -> str:
        image = bpy.data.images.new(name, 4, 2, alpha=True)
        image.pixels.foreach_set(np.tile(np.float32(color), 8))
        image.filepath_raw, image.file_format = str(tmp_path / name), "PNG"
        image.save()
        bpy.data.images.remove(image)
        return str(tmp_path / name)

    return save


@pytest.fixture
def read_picture():
    """read_picture(path) -> (h, w, 4) float32 from a file with a single picture, row 0 at the bottom."""

    def read(path) -> np.ndarray:
        (only,) = read_passes(path).values()
        return only

    return read


@pytest.fixture
def picture(scene, read_picture):
    """picture() -> (h, w, 4) float32 of a rendered still, read back from its file."""

    def render() -> np.ndarray:
        bpy.ops.render.render(write_still=True)
        return read_picture(scene.render.filepath)

    return render


@pytest.fixture
def passes(scene):
    """passes() -> name of layer and pass -> array, read from the multilayer file that a render writes."""

    def render() -> dict[str, np.ndarray]:
        set_format(scene.render, "OPEN_EXR_MULTILAYER")
        bpy.ops.render.render(write_still=True)
        return read_passes(scene.render.filepath)

    return render


def read_passes(path) -> dict[str, np.ndarray]:
    """ "Layer.Pass" (or "" in a file of one picture) -> (h, w) or (h, w, channels) float32, row 0 at the bottom."""
    import OpenEXR

    channels = {}
    for part in OpenEXR.File(str(path), separate_channels=True).parts:
        for name, channel in part.channels.items():
            layer, _, letter = name.rpartition(".")
            channels.setdefault(layer, {})[letter] = channel.pixels[::-1]
    return {layer: _joined(letters) for layer, letters in channels.items()}


def _joined(letters: dict[str, np.ndarray]) -> np.ndarray:
    channels = [letters[letter] for letter in sorted(letters, key="RGBArgbaXYZ".index)]
    return np.stack(channels, axis=-1) if len(channels) > 1 else channels[0]


@pytest.fixture
def said(capfd):
    """said() -> all that Blender has reported so far, as a user reads it in the console."""
    return lambda: capfd.readouterr().out


@pytest.fixture
def switch_to_cycles(scene):
    """switch_to_cycles(samples, filter_width) makes the next picture one of Cycles, to compare ours with."""

    def switch(samples=1, filter_width=1.5):
        scene.render.engine = "CYCLES"
        scene.cycles.samples, scene.cycles.use_denoising = samples, False
        scene.cycles.filter_width = filter_width

    return switch


@pytest.fixture
def switch_to_eevee(scene):
    """switch_to_eevee(samples, has_shadows) makes the next picture one of EEVEE.

    In software its shadow maps take a second a sample, and its map of the world two.
    """

    def switch(samples=1, has_shadows=False):
        scene.render.engine = "BLENDER_EEVEE" if bpy.app.version >= (5, 0) else "BLENDER_EEVEE_NEXT"
        scene.eevee.taa_render_samples, scene.eevee.use_shadows = samples, has_shadows
        scene.eevee.shadow_pool_size, scene.eevee.shadow_resolution_scale = "16", 0.25
        assert scene.world is None, "give this test's world the smallest map too"
        black = scene.world = bpy.data.worlds.new("black")
        black.color, black.probe_resolution = (0, 0, 0), "128"
        if black.node_tree:
            black.node_tree.nodes["Background"].inputs["Color"].default_value = (0, 0, 0, 1)

    return switch


@pytest.fixture
def assert_same_picture():
    """assert_same_picture(a, b, ties): equal within 1e-4, except for at most `ties` pixels at splats' edges."""

    def check(a: np.ndarray, b: np.ndarray, ties: int = 0) -> None:
        assert a.shape == b.shape and bool(a.any()) and bool(b.any())
        different = np.count_nonzero(np.abs(a - b).max(axis=2) > 1e-4)
        assert different <= ties

    return check


@pytest.fixture
def slanting(scene, add_camera):
    """The scene in 64 x 64 pixels, lit as Cycles lights it, seen from above at a slant."""
    scene.surfel_splatting.shading, scene.surfel_splatting.supersampling = "principled", 2
    scene.render.resolution_x = scene.render.resolution_y = 64
    add_camera((0, -6, 5), (0.87, 0, 0), lens=60)
    return scene


@pytest.fixture
def packed_polygons(monkeypatch):
    """The list of the polygons packed for the device, in order."""
    made, pack = [], polygons.pack_polygons
    monkeypatch.setattr(resources, "pack_polygons", lambda shape: made.append(shape) or pack(shape))
    return made


@pytest.fixture
def live(scene, add_camera):
    """The scene with Render Meshes as Surfels at resolution 32, seen from above."""
    add_camera(location=(0, 0, 10))
    scene.surfel_splatting.render_meshes = "SURFELS"
    scene.surfel_splatting.mesh_resolution = 32
    scene.surfel_splatting.detail_tolerance = 0  # merged surfels would count
    return scene.surfel_splatting


@pytest.fixture
def packed_surfels(monkeypatch):
    """The list of surfels packed for the device, in order."""
    packed, pack = [], storages.pack_surfels
    monkeypatch.setattr(storages, "pack_surfels", lambda surfels, order: packed.append(surfels) or pack(surfels, order))
    return packed
