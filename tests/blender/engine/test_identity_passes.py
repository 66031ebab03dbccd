# SPDX-License-Identifier: GPL-3.0-or-later
"""Object Index, Material Index and Cryptomatte, in a multilayer file and in the compositor, are those of Cycles."""

import json

import bpy
import numpy as np
import pytest

from splat_addon.rendering import EMPTY_DEPTH
from splat_addon.rendering.cryptomatte import murmur3_32, name_hash

HAS_LONG_NAMES = bpy.app.version >= (5, 0, 0)
OBJECT_INDEX = "Object Index" if HAS_LONG_NAMES else "IndexOB"
MATERIAL_INDEX = "Material Index" if HAS_LONG_NAMES else "IndexMA"


@pytest.fixture
def two_sheets(scene, add_camera, add_sheet):
    """A sheet of 2 x 2 on the left that covers half of a larger one; indices, names and materials differ."""
    add_camera((0, 0, 6))
    back, front = add_sheet(side=3, count=120, name="Back"), add_sheet(side=2, count=120, name="Würfel")
    front.location = (-0.6, 0, 1)
    back.pass_index, front.pass_index = 3, 20_000
    for sheet, index in ((back, 7), (front, 8)):
        material = bpy.data.materials.new(sheet.name)
        material.pass_index = index
        sheet.data.materials.append(material)
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_object_index = layer.use_pass_material_index = True
    layer.use_pass_cryptomatte_object = True
    return back, front


def matte(stored: dict, name: str, layers: int = 3) -> np.ndarray:
    """The (h, w) coverage of a name, added up from the passes as a reader of the file does."""
    total = 0.0
    for number in range(layers):
        ranks = stored[f"ViewLayer.CryptoObject{number:02d}"]
        for first in (0, 2):
            bits = np.ascontiguousarray(ranks[..., first]).view(np.uint32)
            total = total + ranks[..., first + 1] * (bits == name_hash(name))
    return total


@pytest.mark.parametrize("method", ["quad", "mip"])
def test_the_file_says_whose_each_pixel_is(method, scene, two_sheets, passes):
    scene.surfel_splatting.method = method
    stored = passes()
    assert stored.keys() == {
        "ViewLayer.Combined", "ViewLayer.Depth", f"ViewLayer.{OBJECT_INDEX}", f"ViewLayer.{MATERIAL_INDEX}",
        "ViewLayer.CryptoObject00", "ViewLayer.CryptoObject01", "ViewLayer.CryptoObject02",
    }  # fmt: skip
    depth = stored["ViewLayer.Depth"]
    is_front, is_back = depth < 5.5, (depth > 5.5) & (depth < EMPTY_DEPTH)
    assert is_front.sum() > 50 and is_back.sum() > 50
    assert np.array_equal(stored[f"ViewLayer.{OBJECT_INDEX}"], 20_000.0 * is_front + 3.0 * is_back)
    assert np.array_equal(stored[f"ViewLayer.{MATERIAL_INDEX}"], 8.0 * is_front + 7.0 * is_back)
    shares = matte(stored, "Würfel"), matte(stored, "Back")
    np.testing.assert_allclose(sum(shares), stored["ViewLayer.Combined"][..., 3], atol=1e-6)
    assert (shares[0][is_front] >= 0.25).all() and (shares[1][is_back] >= 0.25).all()


def test_the_matte_is_cycles_matte(scene, two_sheets, passes, switch_to_cycles):
    """The names are equal, and the shares differ no more than two pixel filters do."""
    scene.surfel_splatting.supersampling = 8
    scene.surfel_splatting.detail_tolerance = 0  # merged surfels protrude by up to a share of a pixel
    ours = passes()
    for sheet, side in zip(two_sheets, (3, 2), strict=True):
        plane = bpy.data.meshes.new(sheet.name)
        corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]) * side / 2
        plane.from_pydata(corners.tolist(), [], [(0, 1, 2, 3)])
        sheet.data = plane
    switch_to_cycles(samples=64, filter_width=1.0)
    theirs = passes()
    for name in ("Würfel", "Back"):
        mine, other = matte(ours, name), matte(theirs, name)
        assert other.max() == pytest.approx(1) and np.abs(mine - other).mean() < 0.02


def test_the_file_explains_the_matte(scene, two_sheets, passes):
    import OpenEXR

    passes()
    header = OpenEXR.File(scene.render.filepath, separate_channels=True).parts[0].header
    prefix = f"cryptomatte/{murmur3_32(b'ViewLayer.CryptoObject'):08x}"[:-1]
    fields = {key: value for key, value in header.items() if key.startswith("cryptomatte/")}
    assert fields[f"{prefix}/name"] == "ViewLayer.CryptoObject"
    assert fields[f"{prefix}/hash"] == "MurmurHash3_32" and fields[f"{prefix}/conversion"] == "uint32_to_float32"
    manifest = json.loads(fields[f"{prefix}/manifest"])
    assert manifest == {name: f"{name_hash(name):08x}" for name in ("Back", "Würfel")}


@pytest.mark.parametrize(("levels", "layers"), [(2, 1), (6, 3), (16, 8)])
def test_there_are_as_many_layers_as_levels_ask_for(levels, layers, scene, two_sheets, passes):
    scene.view_layers[0].pass_cryptomatte_depth = levels
    stored = passes()
    assert sum("CryptoObject" in name for name in stored) == layers
    np.testing.assert_allclose(matte(stored, "Back", layers).max(), 1)


@pytest.fixture
def composed(scene, picture):
    """composed(make) -> the red channel of the composited picture; make(nodes, layers node) returns the compositor's
    output.
    """

    def render(make) -> np.ndarray:
        if HAS_LONG_NAMES:
            tree = scene.compositing_node_group = bpy.data.node_groups.new("compositing", "CompositorNodeTree")
            tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
            end = tree.nodes.new("NodeGroupOutput").inputs[0]
        else:
            scene.use_nodes = True
            tree = scene.node_tree
            tree.nodes.clear()
            end = tree.nodes.new("CompositorNodeComposite").inputs["Image"]
        layers = tree.nodes.new("CompositorNodeRLayers")
        tree.links.new(make(tree, layers), end)
        return picture()[..., 0]

    return render


@pytest.mark.parametrize("name", ["Back", "Würfel"])
def test_the_compositor_finds_an_object_by_its_name(name, scene, two_sheets, composed, passes):
    scene.surfel_splatting.supersampling = 4

    def make(tree, layers):
        node = tree.nodes.new("CompositorNodeCryptomatteV2")
        node.source, node.scene = "RENDER", scene
        node.layer_name = "ViewLayer.CryptoObject"
        node.matte_id = name
        tree.links.new(layers.outputs["Image"], node.inputs["Image"])
        return node.outputs["Matte"]

    composite = composed(make)
    assert 0.05 < composite.mean() < 0.9 and composite.max() == pytest.approx(1)
    frame = matte(passes(), name)
    np.testing.assert_allclose(composite, frame, atol=1e-5)


def test_the_compositor_masks_by_index(scene, two_sheets, composed, passes):
    def make(tree, layers):
        node = tree.nodes.new("CompositorNodeIDMask")
        if hasattr(node, "index"):
            node.index = 20_000
        else:
            node.inputs["Index"].default_value = 20_000
        tree.links.new(layers.outputs[OBJECT_INDEX], node.inputs[0])
        return node.outputs[0]

    composite = composed(make)
    depth = passes()["ViewLayer.Depth"]
    assert np.array_equal(composite, (depth < 5.5).astype(np.float32))


def test_the_compositor_reads_normals_and_positions(scene, two_sheets, composed):
    scene.view_layers[0].use_pass_normal = scene.view_layers[0].use_pass_position = True
    normal = composed(lambda tree, layers: layers.outputs["Normal"])
    assert normal.shape == (32, 32) and not normal.any()  # x coordinates of the surfels that face up
    position = composed(lambda tree, layers: layers.outputs["Position"])
    assert position.min() < -1 and position.max() > 1


def test_instances_and_live_meshes_have_their_objects_names_and_indices(scene, add_camera, passes):
    """The scene has a mesh that the engine samples itself, and a collection instance of it."""
    add_camera((0, 0, 8))
    bpy.ops.mesh.primitive_cube_add(size=1, location=(-1.2, 0, 0))
    cube = bpy.context.object
    cube.name, cube.pass_index = "Cube", 5
    collection = bpy.data.collections.new("cubes")
    bpy.ops.mesh.primitive_cube_add(size=1)
    inner = bpy.context.object
    inner.name, inner.pass_index = "Inner", 6
    scene.collection.objects.unlink(inner)
    collection.objects.link(inner)
    empty = bpy.data.objects.new("empty", None)
    empty.instance_type, empty.instance_collection = "COLLECTION", collection
    empty.location = (1.2, 0, 0)
    scene.collection.objects.link(empty)
    scene.surfel_splatting.render_meshes = "SURFELS"
    scene.view_layers[0].use_pass_object_index = scene.view_layers[0].use_pass_cryptomatte_object = True
    stored = passes()
    index = stored[f"ViewLayer.{OBJECT_INDEX}"]
    assert set(np.unique(index[:, :14])) == {0, 5} and set(np.unique(index[:, 18:])) == {0, 6}
    assert matte(stored, "Cube")[:, :14].max() == 1 and matte(stored, "Inner")[:, 18:].max() == 1
