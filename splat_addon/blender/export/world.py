# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's world to a uniform radiance, or to an environment if its background is an image, to its
sun, and to what the camera sees of it if that differs."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils import Euler

from ...rendering import Environment, Scene
from ...rendering.device.interface import MAX_TEXTURE_EDGE
from ...rendering.scene.sun_apart import sun_apart
from ..materials.node_trees import uses_nodes
from ..materials.surface_shaders import Part
from ..materials.texture_images import UnreadableError, fingerprint, linear_pixels, odd_pixels_sentence, settings_of
from . import passed_over
from .shading import BLACK, color_times_strength, finite_radiance
from .world_shaders import backgrounds

Color = tuple[float, float, float]


class WorldStore:
    """Keeps the `Environment` of a world between frames: the same object while image and rotation are unchanged."""

    def __init__(self):
        self._kept: _Kept | None = None
        self._is_doubted = False

    def begin_frame(self, is_edited: bool) -> None:
        """Start a frame. is_edited: the image's pixels may differ, as after it was reloaded or saved."""
        self._is_doubted |= is_edited

    def around(self, scene: Scene, world: bpy.types.World | None, notes) -> Scene:
        """The scene in that world, whose sun is a light if the world asks for its shadow."""
        scene = replace(scene, **self.read(world, notes))
        return sun_apart(scene, world.sun_threshold) if world is not None and world.use_sun_shadow else scene

    def read(self, world: bpy.types.World | None, notes) -> dict[str, Any]:
        """The fields of a `Scene` that describe its world, which is black if there is none."""
        if world is None:
            return {"world": BLACK}
        for sentence in passed_over.of_world(world):
            notes.add(sentence)
        if not uses_nodes(world):
            return {"world": tuple(world.color)}
        said = set()
        (light, picture), (seen, seen_picture) = (_sum(each, world, said) for each in backgrounds(world, said))
        for sentence in sorted(said):
            notes.add(sentence)
        fields = {"world": light, "environment": self._environment(picture, notes) if picture else None}
        if seen_picture is not None and not _are_same(picture, seen_picture):
            notes.add(
                f"The world {world.name!r} shows a picture to the camera that does not light the scene; the background "
                "is what lights it"
            )
            return fields
        is_hidden = picture is not None and seen_picture is None
        return fields | ({"background": seen, "hides_environment": is_hidden} if is_hidden or seen != light else {})

    def _environment(self, picture: _Picture, notes) -> Environment | None:
        settings = *settings_of(picture.image), picture.rotation.tobytes()
        # Users cannot change pixels between two frames of one render without marking the image dirty.
        is_doubted = self._is_doubted or picture.image.is_dirty
        try:
            if self._kept is None or self._kept.settings != settings or is_doubted:
                key = settings, fingerprint(picture.image)
                if self._kept is None or self._kept[:2] != key:
                    self._kept = _Kept(*key, *_read(picture))
        except UnreadableError as reason:
            notes.add(f"The world's picture cannot be read and counts as white: {reason}")
            return None
        self._is_doubted = False
        for note in self._kept.notes:
            notes.add(note)
        return self._kept.environment


class _Kept(NamedTuple):
    """notes: about the reading."""

    settings: tuple
    fingerprint: int
    environment: Environment
    notes: tuple[str, ...]


def _read(picture: _Picture) -> tuple[Environment, tuple[str, ...]]:
    """The environment, and notes on what it lacks. Raises UnreadableError."""
    image, notes = picture.image, []
    pixels = linear_pixels(image, keep_alpha=False)[..., :3]
    if sentence := odd_pixels_sentence(image):
        notes.append(sentence)
    steps = [-(-edge // MAX_TEXTURE_EDGE) for edge in pixels.shape[:2]]
    if max(steps) > 1:
        pixels = _reduced(pixels, *steps)
        notes.append(
            f"The world's picture {image.name!r} is larger than {MAX_TEXTURE_EDGE:,} pixels, which graphics devices "
            f"hold along an edge; it is shown at {pixels.shape[1]:,} x {pixels.shape[0]:,}"
        )
    return Environment(pixels, picture.rotation), tuple(notes)


def _reduced(pixels: np.ndarray, down: int, across: int) -> np.ndarray:
    """Means over blocks of this many rows and columns; incomplete blocks are dropped."""
    rows, columns = pixels.shape[0] // down, pixels.shape[1] // across
    whole = pixels[: rows * down, : columns * across]
    return whole.reshape(rows, down, columns, across, 3).mean(axis=(1, 3))


def _sum(added: list[Part], world: bpy.types.World, notes) -> tuple[Color, _Picture | None]:
    """The radiance of a sum of backgrounds, and a picture that is multiplied by it if there is one."""
    owner, total = f"The world {world.name!r}", np.zeros(3)
    for part in added:
        picture = _picture(part.shader.socket("Color"), world, notes)
        if picture is None:
            total += part.share * np.array(color_times_strength(part.shader, owner, notes))
            continue
        if len(added) > 1:
            notes.add(f"{owner} mixes a picture with other backgrounds; only the picture is drawn, with its share")
        if part.shader.socket("Strength").is_linked:
            notes.add(f"{owner} has a textured strength; the socket's plain value is used")
        (strength,) = part.shader.plain("Strength").value
        return finite_radiance((part.share * strength,) * 3, owner, notes), picture
    return finite_radiance(tuple(total.tolist()), owner, notes), None


def _are_same(a: _Picture | None, b: _Picture | None) -> bool:
    return a is not None and b is not None and a.image == b.image and np.array_equal(a.rotation, b.rotation)


class _Picture(NamedTuple):
    """rotation: (3, 3), from world directions to the image's directions."""

    image: bpy.types.Image
    rotation: np.ndarray


def _picture(socket: bpy.types.NodeSocket, world: bpy.types.World, notes) -> _Picture | None:
    """The equirectangular image that feeds a colour, possibly rotated by a Mapping node."""
    node = socket.links[0].from_node if socket.is_linked else None
    if node is None or node.type != "TEX_ENVIRONMENT" or node.image is None:
        return None
    if node.projection != "EQUIRECTANGULAR":
        notes.add(
            f"The world {world.name!r} has a picture in {node.projection.title()} projection, which this engine does "
            "not support; the picture is left out"
        )
        return None
    rotation = np.eye(3)
    links = node.inputs["Vector"].links
    if links and links[0].from_node.type == "MAPPING":
        mapping = links[0].from_node
        rotation = np.array(Euler(mapping.inputs["Rotation"].default_value).to_matrix())
        if mapping.vector_type == "TEXTURE":
            rotation = rotation.T
        links = mapping.inputs["Vector"].links
        _note_unused(mapping, world, notes)
    if links and not (links[0].from_node.type == "TEX_COORD" and links[0].from_socket.name == "Generated"):
        notes.add(
            f"The world {world.name!r} places its picture with more nodes than Mapping and generated coordinates; the "
            "others are ignored"
        )
    return _Picture(node.image, rotation)


def _note_unused(mapping: bpy.types.Node, world: bpy.types.World, notes) -> None:
    moved = "Location" in mapping.inputs and any(mapping.inputs["Location"].default_value)
    scale = tuple(mapping.inputs["Scale"].default_value)
    if moved or scale != (1, 1, 1) or mapping.inputs["Rotation"].is_linked:
        notes.add(f"The Mapping node of the world {world.name!r} does more than rotate; only its rotation is used")
