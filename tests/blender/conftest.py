# SPDX-License-Identifier: GPL-3.0-or-later
"""For tests inside Blender: every test starts from an empty file with the add-on registered."""

import sys
from pathlib import Path

import bpy
import numpy as np
import pytest

# for the writers of scans
SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))

import splat_addon  # noqa: E402
from splat_addon.blender.geometry.stored_surfels import read_surfels  # noqa: E402
from splat_addon.blender.translations.messages import messages  # noqa: E402
from splat_addon.surfels import Surfels  # noqa: E402


@pytest.fixture(scope="session", autouse=True)
def add_on():
    splat_addon.register()
    yield
    splat_addon.unregister()


@pytest.fixture(scope="session")
def interface_texts(add_on) -> set[tuple[str, str]]:
    """(context, text) of every text of the interface; all sources are searched for them, which takes a second."""
    return messages()


@pytest.fixture(autouse=True)
def empty_file(add_on):
    """Preferences stay, because to reset them takes five times as long: a test puts back what it changes."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)


@pytest.fixture
def cube():
    """A cube with edges of length 2, active and selected."""
    bpy.ops.mesh.primitive_cube_add(size=2)
    return bpy.context.object


@pytest.fixture
def camera():
    """The scene's camera, 10 units above the origin, looking down."""
    made = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    bpy.context.collection.objects.link(made)
    made.location.z = 10
    bpy.context.scene.camera = made
    bpy.context.view_layer.update()
    return made


@pytest.fixture
def random_surfels():
    """random_surfels(n) -> n surfels of random values, the same every time."""

    def make(count: int) -> Surfels:
        random = np.random.default_rng(7)
        rotations, normals = random.normal(size=(count, 4)), random.normal(size=(count, 3))
        return Surfels(
            positions=random.normal(size=(count, 3)),
            rotations=rotations / np.linalg.norm(rotations, axis=1, keepdims=True),
            scales=random.uniform(0.1, 2.0, (count, 2)),
            normals=normals / np.linalg.norm(normals, axis=1, keepdims=True),
            colors=random.uniform(size=(count, 4)),
            materials=random.integers(0, 9, count),
        )

    return make


@pytest.fixture
def add_object():
    """add_object(mesh) -> an object of that mesh, which is active and the only selected one."""

    def add(mesh: bpy.types.Mesh) -> bpy.types.Object:
        made = bpy.data.objects.new(mesh.name, mesh)
        bpy.context.collection.objects.link(made)
        for selected in bpy.context.selected_objects:
            selected.select_set(False)
        made.select_set(True)
        bpy.context.view_layer.objects.active = made
        return made

    return add


@pytest.fixture
def add_mesh(add_object):
    """add_mesh(name, vertices, faces) -> an object of that mesh, active and selected."""

    def add(name: str, vertices, faces) -> bpy.types.Object:
        mesh = bpy.data.meshes.new(name)
        mesh.from_pydata(vertices, [], faces)
        return add_object(mesh)

    return add


@pytest.fixture
def add_square(add_mesh):
    """add_square(name) -> the selected square 0..1 in x and y, one face, its UV map equal to x and y."""

    def add(name: str = "Square") -> bpy.types.Object:
        square = add_mesh(name, [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
        square.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", [0, 0, 1, 0, 1, 1, 0, 1])
        return square

    return add


@pytest.fixture
def add_nodes():
    """add_nodes(object, build) adds a Geometry Nodes modifier; build(tree, input socket, output socket) fills
    its tree.
    """

    def add(owner: bpy.types.Object, build) -> None:
        tree = bpy.data.node_groups.new("nodes", "GeometryNodeTree")
        for direction in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
        start, end = tree.nodes.new("NodeGroupInput"), tree.nodes.new("NodeGroupOutput")
        build(tree, start.outputs[0], end.inputs[0])
        owner.modifiers.new("nodes", "NODES").node_group = tree

    return add


@pytest.fixture
def convert():
    """convert(**settings) -> the surfel objects that the operator makes from the selection."""

    def run(**settings) -> list[bpy.types.Object]:
        before = set(bpy.data.objects)
        bpy.ops.object.surfels_from_mesh(**settings)
        return sorted(set(bpy.data.objects) - before, key=lambda made: made.name)

    return run


@pytest.fixture
def surfels_of():
    """surfels_of(object) -> the Surfels that the object stores; fails if any of them is unusable."""

    def read(made: bpy.types.Object) -> Surfels:
        surfels, skipped = read_surfels(made.data)
        assert skipped == 0
        return surfels

    return read


@pytest.fixture
def world_positions(surfels_of):
    """world_positions(object) -> (N, 3) float64 centres of its surfels in the world."""

    def read(made: bpy.types.Object) -> np.ndarray:
        bpy.context.view_layer.update()
        matrix = np.array(made.matrix_world, np.float64)
        return surfels_of(made).positions.astype(np.float64) @ matrix[:3, :3].T + matrix[:3, 3]

    return read
