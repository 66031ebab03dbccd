# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels have all values of a glTF model, with materials as Blender's importer builds them."""

import bpy
import numpy as np
import pytest

TEXELS = 4
RANDOM = np.random.default_rng(11)


def image(name, values, space):
    made = bpy.data.images.new(name, TEXELS, TEXELS, alpha=True)
    made.colorspace_settings.name = space
    made.alpha_mode = "CHANNEL_PACKED"
    made.pixels.foreach_set(values.astype(np.float32).ravel())
    made.update()
    made.pack()
    return made


@pytest.fixture
def exported(add_square, tmp_path):
    """A glTF file of the unit square with every texture that surfels know, and the encoded values."""
    square = add_square("Exported")
    material = bpy.data.materials.new("material")
    if bpy.app.version < (5, 0, 0):
        material.use_nodes = True
    tree = material.node_tree
    inputs = tree.nodes["Principled BSDF"].inputs
    encoded = {name: RANDOM.integers(0, 256, (TEXELS, TEXELS, 4)) / 255 for name in ("color", "orm", "emission")}
    encoded["orm"][..., 3] = encoded["emission"][..., 3] = 1
    encoded["normal"] = np.broadcast_to(np.array((204, 128, 230, 255)) / 255, (TEXELS, TEXELS, 4))

    def texture(name, space):
        node = tree.nodes.new("ShaderNodeTexImage")
        node.image, node.interpolation = image(name, encoded[name], space), "Closest"
        return node

    color = texture("color", "sRGB")
    tree.links.new(color.outputs["Color"], inputs["Base Color"])
    tree.links.new(color.outputs["Alpha"], inputs["Alpha"])
    separate = tree.nodes.new("ShaderNodeSeparateColor")
    tree.links.new(texture("orm", "Non-Color").outputs["Color"], separate.inputs[0])
    tree.links.new(separate.outputs["Green"], inputs["Roughness"])
    tree.links.new(separate.outputs["Blue"], inputs["Metallic"])
    tree.links.new(texture("emission", "sRGB").outputs["Color"], inputs["Emission Color"])
    inputs["Emission Strength"].default_value = 3.0
    bump = tree.nodes.new("ShaderNodeNormalMap")
    tree.links.new(texture("normal", "Non-Color").outputs["Color"], bump.inputs["Color"])
    tree.links.new(bump.outputs["Normal"], inputs["Normal"])
    square.data.materials.append(material)
    path = tmp_path / "square.glb"
    bpy.ops.export_scene.gltf(filepath=str(path), use_selection=True)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    return path, encoded


def decoded(encoded):
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


def test_every_texture_of_a_gltf_material_arrives(exported, convert, surfels_of, capfd):
    path, encoded = exported
    bpy.ops.import_scene.gltf(filepath=str(path))
    (square,) = [o for o in bpy.context.view_layer.objects if o.type == "MESH"]
    square.select_set(True)
    bpy.context.view_layer.objects.active = square
    surfels = surfels_of(convert(resolution=4 * TEXELS)[0])
    assert "Warning" not in capfd.readouterr().out
    place = surfels.positions + np.array(bpy.context.object.location)
    column, row = np.floor(place[:, :2] * TEXELS).astype(int).T
    texel = {name: values[row, column] for name, values in encoded.items()}
    assert np.allclose(surfels.colors[:, :3], decoded(texel["color"][:, :3]), atol=1e-5)
    assert np.allclose(surfels.colors[:, 3], texel["color"][:, 3], atol=1e-5)
    assert np.allclose(surfels.roughness, texel["orm"][:, 1], atol=1e-5)
    assert np.allclose(surfels.metallic, texel["orm"][:, 2], atol=1e-5)
    assert np.allclose(surfels.emission, 3 * decoded(texel["emission"][:, :3]), atol=1e-4)
    normal = 2 * encoded["normal"][0, 0, :3] - 1
    assert np.allclose(surfels.normals, normal / np.linalg.norm(normal), atol=1e-4)


def import_model(path):
    bpy.ops.import_scene.gltf(filepath=str(path))
    meshes = [o for o in bpy.context.view_layer.objects if o.type == "MESH" and o.visible_get()]
    for one in bpy.context.view_layer.objects:
        one.select_set(one in meshes)
    return meshes


def test_the_milk_truck_has_the_colours_of_its_materials(models, convert, surfels_of, capfd):
    """White paint, a blue and green sign, green glass and black trim are found; no warning says that something is
    missing.
    """
    import_model(models / "CesiumMilkTruck.glb")
    body = surfels_of(convert(resolution=96)[0])
    assert "plain value" not in capfd.readouterr().out
    paint, glass, trims = (body.colors[body.materials == k, :3] for k in range(3))
    white = np.percentile(paint, 75, axis=0)
    assert white.min() > 0.6 and np.ptp(white) < 0.2, white
    assert (glass[:, 1] > 2 * glass[:, 0]).all() and trims.max() < 0.1
    blue = (body.colors[:, 2] > 2 * body.colors[:, 0]) & (body.materials == 0)
    green = (body.colors[:, 1] > 2 * body.colors[:, 2]) & (body.materials == 0)
    assert 0.005 < blue.mean() < 0.2 and 0.005 < green.mean() < 0.2
    assert body.roughness is None and body.metallic is None and body.emission is None


def test_the_phoenix_glows_and_has_its_feathers_cut_out(models, convert, surfels_of):
    import_model(models / "phoenix_bird.glb")
    bird = [surfels_of(made) for made in convert(resolution=96)]
    assert all(part.emission is not None and part.emission.max() > 0.3 for part in bird)
    feathers = max(bird, key=len).colors[:, 3]
    assert (feathers < 0.1).mean() > 0.05 and (feathers > 0.9).mean() > 0.3
