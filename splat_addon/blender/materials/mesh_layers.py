# SPDX-License-Identifier: GPL-3.0-or-later
"""The layers of a mesh, and the images, that its materials read."""

from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from ...sampling import Image
from .. import working_space
from ..geometry.attributes import has_surfels_beside_faces
from .image_files import TILED, frame_of
from .node_products import ImageSource
from .texture_images import UnreadableError, linear_pixels

#: Layers that follow from the mesh itself, places and directions in object space; no attribute has such a name.
DERIVED = GENERATED, POSITION, NORMAL, TRUE_NORMAL, POINTINESS = (
    "\0generated",
    "\0position",
    "\0normal",
    "\0true normal",
    "\0pointiness",
)

#: data type of an attribute that can be used as a colour -> its property, and its number of components
ATTRIBUTE_TYPES = {
    "FLOAT_COLOR": ("color", 4),
    "BYTE_COLOR": ("color", 4),  # scene-linear, this one too
    "FLOAT_VECTOR": ("vector", 3),
    "FLOAT2": ("vector", 2),
    "FLOAT": ("value", 1),
}
ATTRIBUTE_DOMAINS = ("POINT", "CORNER", "FACE")


@dataclass
class MeshLayers:
    """The layers of a mesh that its materials use, without duplicates, in the order of first use.

    mesh: None if only images are asked for. owner: the evaluated object that shows the mesh. material: the one that is
    read. asks_owner: whether something that was read depends on the owner. colors: attributes, and names of `DERIVED`.
    """

    mesh: bpy.types.Mesh | None
    uvs: list[str] = field(default_factory=list)
    colors: list[str] = field(default_factory=list)
    owner: bpy.types.Object | None = None
    material: bpy.types.Material | None = None
    asks_owner: bool = False
    _images: dict = field(default_factory=dict)

    @property
    def kept_images(self) -> dict:
        """What was made of images, by a key that says of what."""
        return self._images

    def uv(self, name: str) -> int:
        return _index(self.uvs, name)

    def color(self, name: str) -> int:
        name = name or (self.mesh and default_color_layer(self.mesh)) or ""
        attribute = self.mesh.attributes.get(name) if self.mesh else None
        if attribute is None:
            raise UnreadableError(f"the attribute {name!r}, which the mesh does not have")
        if attribute.data_type not in ATTRIBUTE_TYPES or attribute.domain not in ATTRIBUTE_DOMAINS:
            raise UnreadableError(f"the attribute {name!r}, which is {attribute.data_type} on {attribute.domain}")
        return _index(self.colors, name)

    def derived(self, name: str) -> int:
        """The number of a layer of `DERIVED` among those of the colours. Raises UnreadableError without a mesh."""
        if self.mesh is None:
            raise UnreadableError("the mesh")
        return _index(self.colors, name)

    def image(self, source: ImageSource, keep_alpha: bool, any_projection: bool = False) -> Image:
        """The pixels of an Image Texture node; the same object for the same pixels."""
        node = source.node
        if node.image is None:
            raise UnreadableError("an Image Texture node without an image")
        if node.projection != "FLAT" and not any_projection:
            raise UnreadableError(f"an image texture in {node.projection.lower()} projection")
        # Blender's Cubic and Smart equal Linear where a texture is not magnified.
        interpolation = "Closest" if node.interpolation == "Closest" else "Linear"
        is_apart = not keep_alpha and any(not link.is_muted for link in node.outputs["Alpha"].links)
        space = working_space.to_xyz().tobytes()
        # beyond the tiles is nothing that could be repeated
        extension = "EXTEND" if node.image.source == TILED else node.extension
        frame = frame_of(node.image, node.image_user)
        key = node.image.session_uid, keep_alpha, extension, interpolation, is_apart, space, frame
        if key not in self._images:
            self._forget_frames(key)
            pixels = linear_pixels(node.image, keep_alpha, is_apart, frame)
            self._images[key] = Image(pixels, extension, interpolation)
        return self._images[key]

    def _forget_frames(self, key: tuple) -> None:
        """Forget other frames of an image, with what was made of them. key: ends with the frame."""
        for other in [each for each in self._images if each[:-1] == key[:-1]]:
            gone = self._images.pop(other)
            for made, value in [*self._images.items()]:
                if isinstance(value, tuple) and any(gone is source for source in value[-1]):
                    del self._images[made]


def _index(names: list[str], name: str) -> int:
    if name not in names:
        names.append(name)
    return names.index(name)


def default_color_layer(mesh: bpy.types.Mesh) -> str | None:
    """The colour attribute used for rendering, or None. The attribute of surfels joined to the mesh is ignored."""
    if has_surfels_beside_faces(mesh):
        return None
    name = mesh.attributes.default_color_name or mesh.attributes.active_color_name
    return name if name in mesh.color_attributes else None
