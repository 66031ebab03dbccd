# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts Blender's world to a uniform radiance, or to an environment if its background is an image, to its
sun, and to what the camera sees of it if that differs."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any, NamedTuple

import bpy
import numpy as np
from mathutils import Euler

from ...rendering import Environment, Scene
from ...rendering.device.interface import MAX_TEXTURE_EDGE
from ...rendering.scene.numbers import MAX_RADIANCE
from ...rendering.scene.sun_apart import sun_apart
from ..materials.fingerprints import told_of_nodes
from ..materials.graphs.channels import constant_of
from ..materials.graphs.worlds import Sampling, radiance, read_radiance
from ..materials.image_files import SINGLE
from ..materials.node_trees import uses_nodes
from ..materials.surface_shaders import Part, Shader
from ..materials.texture_images import UnreadableError, fingerprint, linear_pixels, odd_pixels_sentence, settings_of
from . import passed_over
from .notes import Notes
from .radiance import BLACK, color_times_strength, finite_radiance
from .world_shaders import Backgrounds, backgrounds

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

    def _environment(self, picture: _Picture | _Evaluated, notes) -> Environment | None:
        if isinstance(picture, _Picture):
            return self._of_image(picture, notes)
        is_same = self._kept is not None and self._kept.settings == picture and not self._is_doubted
        if not is_same:
            self._kept = _Kept(picture, 0, *picture.read())
        self._is_doubted = False
        for note in self._kept.notes:
            notes.add(note)
        return self._kept.environment

    def _of_image(self, picture: _Picture, notes) -> Environment | None:
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

    settings: tuple | _Evaluated
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


def _sum(met: Backgrounds, world: bpy.types.World, notes) -> tuple[Color, _Picture | _Evaluated | None]:
    """The radiance of a sum of backgrounds, and a picture that is multiplied by it if there is one."""
    owner, total, added = f"The world {world.name!r}", np.zeros(3), met.added
    if met.tree is not None:
        rays = met.rays if met.is_asked else ""
        return (1.0, 1.0, 1.0), _Evaluated(owner, told_of_nodes(world), (1.0,), rays, [met.tree], met)
    if len(added) == 1 and constant_of(added[0].shader, "Strength") is not None:
        picture = _picture(added[0].shader.socket("Color"))
        if picture is not None:
            (strength,) = constant_of(added[0].shader, "Strength")
            return finite_radiance((added[0].share * strength,) * 3, owner, notes), picture
    varying = [part for part in added if _varies(part.shader)]
    if varying and not all(map(_is_unreadable, varying)):
        shares = tuple(part.share for part in added)
        return (1.0, 1.0, 1.0), _Evaluated(
            owner, told_of_nodes(world), shares, "", [part.shader for part in added], met
        )
    for part in added:
        total += part.share * np.array(color_times_strength(part.shader, owner, notes))
    return finite_radiance(tuple(total.tolist()), owner, notes), None


def _varies(shader: Shader) -> bool:
    """Whether it sends out other light in other directions."""
    return any(shader.socket(name).is_linked and constant_of(shader, name) is None for name in ("Color", "Strength"))


def _is_unreadable(part: Part) -> bool:
    try:
        read_radiance(part.shader)
    except UnreadableError:
        return True
    return False


def _are_same(a, b) -> bool:
    """Whether two results of `_sum` have the same picture."""
    if isinstance(a, _Picture) and isinstance(b, _Picture):
        return a.image == b.image and np.array_equal(a.rotation, b.rotation)
    return a is not None and a == b


@dataclass(frozen=True)
class _Evaluated:
    """A picture that nodes make. owner: the subject of a sentence. told: the fingerprint of all nodes. shares: of the
    shaders that are added. rays: which, if it depends on them."""

    owner: str
    told: str
    shares: tuple[float, ...]
    rays: str
    shaders: list[Shader] = field(compare=False)
    met: Backgrounds = field(compare=False)

    def read(self) -> tuple[Environment, tuple[str, ...]]:
        """The environment, and notes on what it lacks."""
        notes, found, read = Notes(), 0.0, []

        def plain(shader: Shader) -> Color:
            return color_times_strength(shader, self.owner, notes)

        for share, shader in zip(self.shares, self.shaders, strict=True):
            graph, sampling = read_radiance(shader, self.met.factor, plain)
            for reason, used in graph.doubts.items():
                notes.add(f"{self.owner} has {reason}; {used}")
            read.append((share, graph.graph, sampling))
        rows = max(sampling.rows for _, _, sampling in read)
        suns = [sun for _, _, sampling in read for sun in sampling.suns]
        for share, graph, _ in read:
            found = found + share * radiance(graph, Sampling(rows, suns))
        return Environment(np.clip(found, 0, MAX_RADIANCE).astype(np.float32)), tuple(notes.counts)


class _Picture(NamedTuple):
    """rotation: (3, 3), from world directions to the image's directions."""

    image: bpy.types.Image
    rotation: np.ndarray


def _picture(socket: bpy.types.NodeSocket) -> _Picture | None:
    """The equirectangular image that feeds a colour, rotated by a Mapping node at most; None for anything else, which
    is evaluated."""
    node = socket.links[0].from_node if socket.is_linked else None
    if node is None or node.type != "TEX_ENVIRONMENT" or node.image is None or node.mute:
        return None
    if node.projection != "EQUIRECTANGULAR" or node.image.source not in SINGLE:
        return None
    rotation = np.eye(3)
    links = node.inputs["Vector"].links
    if links and links[0].from_node.type == "MAPPING":
        mapping = links[0].from_node
        if mapping.mute or not _only_rotates(mapping):
            return None
        rotation = np.array(Euler(mapping.inputs["Rotation"].default_value).to_matrix())
        if mapping.vector_type == "TEXTURE":
            rotation = rotation.T
        links = mapping.inputs["Vector"].links
    is_plain = not links or (links[0].from_node.type == "TEX_COORD" and links[0].from_socket.name == "Generated")
    return _Picture(node.image, rotation) if is_plain else None


def _only_rotates(mapping: bpy.types.Node) -> bool:
    moved = "Location" in mapping.inputs and any(mapping.inputs["Location"].default_value)
    is_linked = any(socket.is_linked for socket in mapping.inputs if socket.name != "Vector")
    return not moved and tuple(mapping.inputs["Scale"].default_value) == (1, 1, 1) and not is_linked
