# SPDX-License-Identifier: GPL-3.0-or-later
"""Many materials beside each other: squares of one mesh, as Cycles renders them and as surfels take their values.

Each material is an emission of a node chain; a square is `SIDE` x `SIDE` pixels, and both look at the pixels' centres.
"""

from __future__ import annotations

from types import SimpleNamespace

import bpy
import numpy as np

from splat_addon.blender.materials.node_walks import input_of
from splat_addon.blender.meshes.mesh_extraction import read_mesh
from splat_addon.sampling.materials.material_sampler import MaterialSampler, Samples

SIDE = 16
COLUMNS = 8


class Chain:
    """The node tree of one square. `color` and `number` vary over it."""

    def __init__(self, name: str):
        self.material = bpy.data.materials.new(name)
        if bpy.app.version < (5, 0, 0):
            self.material.use_nodes = True
        self.material.pass_index = 2
        self.tree = self.material.node_tree
        self.tree.nodes.clear()
        self.end = self.add("Emission")
        output = self.add("OutputMaterial")
        self.tree.links.new(self.end.outputs[0], output.inputs["Surface"])

    def add(self, kind: str, inputs=None, **settings) -> bpy.types.Node:
        """A node; inputs: identifier or index -> value or socket. What its mode does not use is ignored."""
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for key, value in settings.items():
            setattr(node, key, value)
        for key, value in (inputs or {}).items():
            socket = node.inputs[key] if isinstance(key, int) else input_of(node, key)
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, socket)
            else:
                socket.default_value = value
        return node

    @property
    def uv(self) -> bpy.types.NodeSocket:
        return self.add("TexCoord").outputs["UV"]

    @property
    def number(self) -> bpy.types.NodeSocket:
        """-1 to 2 over the square."""
        mapped = self.add("MapRange", {"Value": self.part("X"), "To Min": -1.0, "To Max": 2.0})
        return mapped.outputs[0]

    def part(self, axis: str) -> bpy.types.NodeSocket:
        """A texture coordinate, 0 to 1."""
        return self.add("SeparateXYZ", {0: self.uv}).outputs[axis]

    @property
    def color(self) -> bpy.types.NodeSocket:
        """Colours of all hues, some with numbers above 1."""
        parts = {0: self.part("X"), 1: self.part("Y"), 2: self.math("MULTIPLY", self.part("X"), self.part("Y"), 1.5)}
        return self.add("CombineColor", parts).outputs[0]

    def math(self, operation: str, a, b=0.0, c=0.0) -> bpy.types.NodeSocket:
        return self.add("Math", {0: a, 1: b, 2: c}, operation=operation).outputs[0]

    def ends_in(self, socket: bpy.types.NodeSocket) -> None:
        self.tree.links.new(socket, self.end.inputs["Color"])


def compared(builds: dict, tmp_path, is_filtered: bool = True) -> dict[str, SimpleNamespace]:
    """name -> cycles, ours: (SIDE, SIDE, 3), and db: their PSNR over the range of Cycles' values.

    builds: name -> function of a `Chain` that returns the socket to show.
    is_filtered: whether ours are means over pixels.
    """
    chains = []
    for name, build in builds.items():
        chains.append(Chain(name))
        chains[-1].ends_in(build(chains[-1]))
    square = _squares([chain.material for chain in chains])
    bpy.context.view_layer.update()
    pictures = _by_cycles(len(chains), tmp_path / "atlas.exr"), _by_surfels(square, len(chains), is_filtered)
    return {name: _result(*(picture[k] for picture in pictures)) for k, name in enumerate(builds)}


def _result(cycles: np.ndarray, ours: np.ndarray) -> SimpleNamespace:
    error = np.square(cycles - ours).mean()
    # a picture is compared as it is seen: its own range, at least 1
    largest = max(1.0, float(np.abs(cycles).max()))
    return SimpleNamespace(cycles=cycles, ours=ours, db=float(10 * np.log10(largest**2 / max(error, 1e-20))))


def _squares(materials: list[bpy.types.Material]) -> bpy.types.Object:
    """Squares of the size 1, row by row from below."""
    rows = -(-len(materials) // COLUMNS)
    corners = [(k % COLUMNS + x, k // COLUMNS + y, 0) for k in range(len(materials)) for x, y in _CORNERS]
    mesh = bpy.data.meshes.new("atlas")
    mesh.from_pydata(corners, [], [range(4 * k, 4 * k + 4) for k in range(len(materials))])
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", np.tile(np.ravel(_CORNERS), len(materials)).astype(float))
    painted = mesh.color_attributes.new("Col", "FLOAT_COLOR", "CORNER")
    colors = np.random.default_rng(2).random((len(materials), 3, 4))
    colors = np.concatenate([colors, colors[:, :1] + colors[:, 2:] - colors[:, 1:2]], axis=1)  # linear over the square
    painted.data.foreach_set("color", colors.astype(np.float32).ravel())
    for material in materials:
        mesh.materials.append(material)
    mesh.polygons.foreach_set("material_index", np.arange(len(materials), dtype=np.int32))
    made = bpy.data.objects.new("atlas", mesh)
    made.color, made.pass_index = (0.2, 0.4, 0.6, 0.8), 3
    bpy.context.collection.objects.link(made)
    camera = bpy.data.objects.new("above", bpy.data.cameras.new("above"))
    bpy.context.collection.objects.link(camera)
    camera.data.type, camera.data.ortho_scale = "ORTHO", max(COLUMNS, rows)
    camera.location = COLUMNS / 2, rows / 2, 5
    scene = bpy.context.scene
    scene.camera = camera
    scene.render.resolution_x, scene.render.resolution_y = COLUMNS * SIDE, rows * SIDE
    return made


_CORNERS = ((0, 0), (1, 0), (1, 1), (0, 1))


def _by_cycles(count: int, path) -> np.ndarray:
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising, scene.cycles.device = 1, False, "CPU"
    scene.cycles.pixel_filter_type, scene.cycles.filter_width, scene.render.threads_mode = "BOX", 0.01, "FIXED"
    scene.render.threads, scene.render.filter_size = 1, 0.01
    settings = scene.render.image_settings
    settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGB"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(str(path))
    width, height = image.size
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height // SIDE, SIDE, COLUMNS, SIDE, image.channels)[..., :3]
    return pixels.swapaxes(1, 2).reshape(-1, SIDE, SIDE, 3)[:count]


def _by_surfels(square: bpy.types.Object, count: int, is_filtered: bool) -> np.ndarray:
    evaluated = square.evaluated_get(bpy.context.evaluated_depsgraph_get())
    mesh = read_mesh(evaluated, evaluated.data).triangles
    at = (np.arange(SIDE, dtype=np.float32) + 0.5) / SIDE
    x, y = np.tile(at, SIDE), np.repeat(at, SIDE)

    def over_squares(corner_values):
        """(columns, n), and their steps to the next pixel, from those at the corners of two triangles a square."""
        if corner_values is None:
            return None, None
        first, second, third = np.moveaxis(corner_values[::2].astype(np.float64), 1, 0)
        right, up = second - first, third - second
        values = first[:, None] + x[:, None] * right[:, None] + y[:, None] * up[:, None]
        steps = [np.repeat(along[:, None], len(x), axis=1) / SIDE for along in (right, up)]
        return values.reshape(-1, values.shape[2]).T, np.stack([s.reshape(-1, s.shape[2]).T for s in steps])

    uvs, uv_steps = over_squares(mesh.corner_uvs)
    colors, color_steps = over_squares(mesh.corner_colors)
    if not is_filtered:
        uv_steps = color_steps = None
    materials = np.repeat(np.arange(count), SIDE * SIDE)
    total = len(materials)
    sampler = MaterialSampler(mesh.surfaces)
    out = {"colors": np.empty((total, 4), np.float32), "emission": np.empty((total, 3), np.float32)}
    for name in sampler.optional:
        out.setdefault(name, np.empty(total, np.float32))
    samples = Samples(materials, colors, uvs, uv_steps, None, color_steps)
    constants = [surface.emission.value for surface in mesh.surfaces]
    out["emission"][:] = np.repeat(np.array(constants, np.float32), SIDE * SIDE, axis=0)
    sampler.fill(out, samples)
    return out["emission"].reshape(count, SIDE, SIDE, 3)
