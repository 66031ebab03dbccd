# SPDX-License-Identifier: GPL-3.0-or-later
"""Bakes materials with Cycles in a temporary scene, from copies of the converted objects onto one small square per
surfel.

Baking from the copies to the squares ("selected to active") evaluates the materials at the surfels themselves: no UV
map is needed, no image size chosen, and the user's scene is not touched. Each square covers a surfel's cell and four
pixels of an image, whose mean is the surfel's. (Vertex colours would do, but their bake gives bump nodes nothing to
differentiate.)
"""

from __future__ import annotations

import math
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ..geometry.sources import shown_by
from .node_trees import uses_nodes
from .node_walks import linked
from .shader_mixes import emitted
from .slots import slot_materials
from .surface_shaders import SHADERS, surface_shader

#: Pixels along the side of a square.
SIDE = 2

#: Value of a pixel whose rays hit nothing.
_MISSED = -1.0

#: Settings of `bpy.ops.object.bake`, by kind.
_KINDS = {
    "EMIT": {},
    "NORMAL": {"normal_space": "OBJECT", "normal_r": "POS_X", "normal_g": "POS_Y", "normal_b": "POS_Z"},
}


class BakeScene:
    """A context that removes everything it made at its end.

    Raises ValueError if Blender has no Cycles.
    """

    def __init__(self, sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph):
        self._made: list[bpy.types.ID] = []
        self._copies: dict[bpy.types.Material, bpy.types.Material] = {}
        self._objects: list[bpy.types.Object] = []
        try:
            self._scene = self._keep(bpy.data.scenes.new("surfels baking"))
            self._use_cycles()
            for source in sources:
                for piece in shown_by(source, depsgraph, self._copied).pieces:
                    mesh, asked = piece.content
                    self._objects += [self._object(mesh, matrix, asked) for matrix in piece.matrices]
        except BaseException:
            self.__exit__()
            raise

    def __enter__(self) -> BakeScene:
        return self

    def __exit__(self, *_) -> None:
        bpy.data.batch_remove(self._made)

    def bake(
        self, kind: str, channel: str, materials: set[bpy.types.Material], corners: np.ndarray, reach: float
    ) -> np.ndarray:
        """(n, 4, 3) float32 values in the four pixels of n squares; NaN where the bake hit nothing.

        kind: "EMIT" or "NORMAL" (of world space, 0 to 1). channel: the field of `Surface` whose
        input becomes the emission of these materials. corners: (n, 4, 3) of the squares, world space. reach: world
        units above and below a square within which a surface is looked for.
        """
        for material in materials:
            if kind == "EMIT":
                _emit(self._copies[material], channel)
        made = len(self._made)
        try:
            image, squares = self._squares(corners)
            objects = [*self._objects, squares]
            with bpy.context.temp_override(
                scene=self._scene,
                view_layer=self._scene.view_layers[0],
                selected_objects=objects,
                selected_editable_objects=objects,
                active_object=squares,
                object=squares,
            ):
                bpy.ops.object.bake(
                    type=kind,
                    target="IMAGE_TEXTURES",
                    use_selected_to_active=True,
                    cage_extrusion=reach,
                    max_ray_distance=2 * reach,
                    margin=0,
                    use_clear=False,
                    **_KINDS[kind],
                )
            return _cells(image, len(corners))
        finally:
            bpy.data.batch_remove(self._made[made:])
            del self._made[made:]
            for copy, original in ((self._copies[material], material) for material in materials):
                if kind == "EMIT":
                    _restore(copy, original)

    def _keep(self, made):
        self._made.append(made)
        return made

    def _use_cycles(self) -> None:
        try:
            self._scene.render.engine = "CYCLES"
        except TypeError:
            raise ValueError(
                "Materials are baked by Cycles, which this Blender does not have; enable its add-on."
            ) from None
        self._scene.cycles.samples = 1
        self._scene.cycles.use_denoising = False
        self._scene.cycles.device = "CPU"

    def _copied(self, evaluated: bpy.types.Object, mesh: bpy.types.Mesh) -> tuple[bpy.types.Mesh, _Asked]:
        """A copy of an evaluated mesh, with copies of its materials, and what materials can ask about its object."""
        copy = self._keep(mesh.copy())
        # Generated coordinates refer to the bounding box before modifiers.
        plain = evaluated.original.data
        if hasattr(plain, "texspace_size"):
            copy.use_auto_texspace = False
            copy.texspace_location, copy.texspace_size = plain.texspace_location, plain.texspace_size
        for index, material in enumerate(slot_materials(evaluated, mesh)):
            own = self._material(material.original) if material else None
            if index < len(copy.materials):
                copy.materials[index] = own
            else:
                copy.materials.append(own)
        return copy, _Asked.about(evaluated)

    def _material(self, original: bpy.types.Material) -> bpy.types.Material:
        if original not in self._copies:
            self._copies[original] = self._keep(original.copy())
            self._copy_groups(self._copies[original].node_tree)
        return self._copies[original]

    def _copy_groups(self, tree: bpy.types.NodeTree | None) -> None:
        """Give a copied tree its own groups of shaders, to which nodes may be added."""
        for node in tree.nodes if tree else ():
            if node.type == "GROUP" and node.node_tree and any(socket.type == "SHADER" for socket in node.outputs):
                node.node_tree = self._keep(node.node_tree.copy())
                self._copy_groups(node.node_tree)

    def _object(self, mesh: bpy.types.Mesh, matrix: np.ndarray, asked: _Asked | None = None) -> bpy.types.Object:
        made = self._keep(bpy.data.objects.new(mesh.name, mesh))
        self._scene.collection.objects.link(made)
        made.matrix_world = Matrix(matrix)
        if asked is not None:
            made.color, made.pass_index = asked.color, asked.index
            for name, value in asked.properties.items():
                made[name] = value
        return made

    def _squares(self, corners: np.ndarray) -> tuple[bpy.types.Image, bpy.types.Object]:
        """The object of the squares, each on its own pixels of the image."""
        count = len(corners)
        columns = math.ceil(math.sqrt(count))
        rows = -(-count // columns)
        mesh = self._keep(bpy.data.meshes.new("surfels baking"))
        mesh.vertices.add(4 * count)
        mesh.attributes["position"].data.foreach_set("vector", corners.astype(np.float32).ravel())
        mesh.loops.add(4 * count)
        mesh.polygons.add(count)
        mesh.polygons.foreach_set("loop_start", np.arange(0, 4 * count, 4, dtype=np.int32))
        corner_vertices = mesh.attributes.get(".corner_vert") or mesh.attributes.new(".corner_vert", "INT", "CORNER")
        corner_vertices.data.foreach_set("value", np.arange(4 * count, dtype=np.int32))
        cell = np.stack([np.arange(count) % columns, np.arange(count) // columns], axis=1)
        uvs = (cell[:, None] + np.array([(0, 0), (1, 0), (1, 1), (0, 1)])) / (columns, rows)
        mesh.uv_layers.new(name="cells").uv.foreach_set("vector", uvs.astype(np.float32).ravel())
        mesh.update(calc_edges=True)

        size = SIDE * columns, SIDE * rows
        image = self._keep(bpy.data.images.new("surfels baking", *size, alpha=True, float_buffer=True))
        image.colorspace_settings.name = "Non-Color"
        image.pixels.foreach_set(np.full(4 * size[0] * size[1], _MISSED, np.float32))
        material = self._keep(bpy.data.materials.new("surfels baking"))
        if not uses_nodes(material):
            material.use_nodes = True
        node = material.node_tree.nodes.new("ShaderNodeTexImage")
        node.image, material.node_tree.nodes.active = image, node
        mesh.materials.append(material)
        return image, self._object(mesh, np.eye(4))


class _Asked(NamedTuple):
    """What the Object Info and Attribute nodes of a material can ask about an object."""

    color: tuple[float, ...]
    index: int
    properties: dict[str, float | list[float]]

    @classmethod
    def about(cls, owner: bpy.types.Object) -> _Asked:
        listed = ((name, value.to_list() if hasattr(value, "to_list") else value) for name, value in owner.items())
        numbers = {name: value for name, value in listed if isinstance(value, int | float | list)}
        return cls(tuple(owner.color), owner.pass_index, numbers)


def _emit(material: bpy.types.Material, channel: str) -> None:
    """Connect the inputs of that channel, a colour or a number and a strength, to an Emission shader."""
    found = surface_shader(material)
    tree, shader = found.node.id_data, found.node
    emission = tree.nodes.new("ShaderNodeEmission")
    sockets = SHADERS[shader.bl_idname][channel] if shader.bl_idname in SHADERS else ()
    if not sockets:
        tree.links.new(emitted(found, channel), emission.inputs["Color"])
    for socket, into in zip(sockets, ("Color", "Strength"), strict=False):
        source, target = shader.inputs[socket], emission.inputs[into]
        if linked(source) is not None:
            tree.links.new(source.links[0].from_socket, target)
        elif source.type == "VALUE" and target.type == "RGBA":
            target.default_value = (*[source.default_value] * 3, 1.0)
        else:
            target.default_value = source.default_value
    tree.links.new(emission.outputs["Emission"], found.into)


def _restore(copy: bpy.types.Material, original: bpy.types.Material) -> None:
    """Undo `_emit`."""
    emission, shader = surface_shader(copy), surface_shader(original)
    tree = emission.node.id_data
    tree.links.new(tree.nodes[shader.node.name].outputs[0], emission.into)
    tree.nodes.remove(emission.node)


def _cells(image: bpy.types.Image, count: int) -> np.ndarray:
    """(n, 4, 3) pixels of each square."""
    width, height = image.size
    pixels = np.empty(4 * width * height, np.float32)
    image.pixels.foreach_get(pixels)
    cells = pixels.reshape(height // SIDE, SIDE, width // SIDE, SIDE, 4).swapaxes(1, 2).reshape(-1, SIDE * SIDE, 4)
    cells = cells[:count]
    return np.where(cells[..., 3:] == _MISSED, np.nan, cells[..., :3])
