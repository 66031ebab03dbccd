# SPDX-License-Identifier: GPL-3.0-or-later
"""A scene's surfels as splats in eye space, and where they fall on the picture.

First step of `render_exact`: everything that depends on one splat and the camera alone.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace

import numpy as np

from ..large_surfels import LARGE_WEIGHT, are_large, grains
from ..normal_fields import changes, share_of
from ..rendering.scene import Instance, Placed, Scene
from ..rendering.scene.camera import Camera
from ..rendering.scene.finish import PLAIN
from ..rendering.scene.light import MAX_LIGHT_SETS
from ..rendering.settings import Settings
from ..surfels import HIDDEN, Surfels, field_values
from .brdf import unit
from .textures import surfel_textures

#: Weight of a back relative to a front, and how much farther it is moved away: shaders/lib/sides.glsl.
BACK_WEIGHT = 1e-3
BACK_EPSILON = 2.0

#: The largest stored blend depth, in radii: rendering/upload/packing.py.
FITTED_BLENDING = 255 / 256

#: A splat with a smaller visible share is not drawn at all: shaders/lib/sides.glsl.
LEAST_OPACITY = 1e-3


@dataclass(frozen=True, eq=False)
class Splats:
    """N ellipses {center + a u + b v : a^2 + b^2 <= 1} in eye space (right-handed, looking down -Z), float64.

    center: (N, 3). u, v: (N, 3) conjugate half-diameters, world units. plane: (N, 3) u x v, not unit.
    normal: (N, 3) unit shading normal turned to the viewer. color: (N, 3) scene-linear.
    surface: (N, 10 + F) roughness, metallic, reflectance at normal incidence, r, g, b of the emission, 1 in the
        column of the set of objects that it belongs to, and the numbers of its finish, if the scene has any.
    is_back: (N,) bool: its inward side is seen.
    texture: (N,) objects, the `SurfaceTexture` that takes the place of color, or None. uv: (N, 2) at the centre;
    uv_along: (N, 2, 2), its change along u (row 0) and v (row 1). uv_border: (N, 2) m of the line m . q = 1 behind
    which the texture is not looked up.
    clip: (N, 2, 3) lines in (a, b) at which each ends, and reflex: (N,) bool, as `Surfels.clip_lines` gives them.
    blend: (N,) how far off its plane it blends with others, in radii; infinite: not known.
    opacity: (N,), 1 where not is_transparent: (N,) bool, of instances that something shows through.
    is_holdout: (N,) bool, of those that hide and show nothing. offset: (N,) how much farther back than by its radius
    each is moved to find what hides it, world units.
    normal_along: (N, 2, 3) change of the normal along u and v, as `normal_fields` describes it; 0: none.
    """

    center: np.ndarray
    u: np.ndarray
    v: np.ndarray
    plane: np.ndarray
    normal: np.ndarray
    color: np.ndarray
    surface: np.ndarray
    is_back: np.ndarray
    texture: np.ndarray
    uv: np.ndarray
    uv_along: np.ndarray
    uv_border: np.ndarray
    clip: np.ndarray
    reflex: np.ndarray
    blend: np.ndarray
    opacity: np.ndarray
    is_transparent: np.ndarray
    is_holdout: np.ndarray
    offset: np.ndarray
    normal_along: np.ndarray

    def __len__(self) -> int:
        return len(self.center)

    def grain(self) -> np.ndarray:
        """(N,) what a splat's epsilon is measured in, world units: the radius, but for large surfels."""
        return self.radius() * grains(np.minimum(self.blend, 1))

    def radius(self) -> np.ndarray:
        """(N,) the longer half-diameter, world units."""
        return np.sqrt(np.maximum(np.einsum("ij,ij->i", self.u, self.u), np.einsum("ij,ij->i", self.v, self.v)))

    @property
    def is_clipped(self) -> bool:
        """Whether a clip line cuts any of the splats."""
        return bool((self.clip[:, :, 2] < 1).any())

    def side_weight(self) -> np.ndarray:
        """(N,) weight of the visible side: small for a back, unless the surfels have blend depths; large surfels have
        more."""
        large = np.where(are_large(np.minimum(self.blend, 1)), LARGE_WEIGHT, 1.0)
        return np.where(self.is_back & (self.blend > FITTED_BLENDING), BACK_WEIGHT, large)

    def push(self, epsilon: float) -> np.ndarray:
        """(N,) distance by which each splat is moved back to find what hides it, world units. epsilon: in radii."""
        return epsilon * self.grain() * np.where(self.is_back, BACK_EPSILON, 1.0) + self.offset

    def blend_depth(self) -> np.ndarray:
        """(N,) distance from its plane up to which each splat blends with others, world units."""
        return self.blend * self.radius()

    def take(self, rows: np.ndarray) -> Splats:
        """The splats of some rows."""
        return Splats(*(getattr(self, f.name)[rows] for f in fields(self)))

    def as_asked(self, settings: Settings) -> Splats:
        """The splats without backs, and moved back further, if the settings say so; as printed, with backs as fronts
        and without blend depths. Of the changes of their normals, the share that is drawn."""
        splats = self.take(np.flatnonzero(~self.is_back)) if settings.culls_backs else self
        along = splats.normal_along * share_of(settings.as_printed)
        splats = replace(splats, offset=np.full(len(splats), settings.epsilon_length), normal_along=along)
        if not settings.as_printed:
            return splats
        return replace(splats, is_back=np.zeros(len(splats), bool), blend=np.full(len(splats), np.inf))

    def as_opaque(self) -> Splats:
        """The same splats, made opaque."""
        return replace(self, opacity=np.ones(len(self)), is_transparent=np.zeros(len(self), bool))


def eye_splats(scene: Scene, camera: Camera) -> Splats:
    """Every instance's surfels in the eye space of `camera`."""
    parts = [_instance_splats(instance, camera, has_finish(scene)) for instance in scene.surfels if instance.is_seen]
    if not parts:
        return _no_splats(10 + len(PLAIN.numbers) * has_finish(scene))
    return Splats(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Splats)))


def _instance_splats(instance: Instance, camera: Camera, with_finish: bool) -> Splats:
    surfels, matrix = instance.surfels, instance.matrix_world
    to_view = camera.world_to_view()[:3, :3]
    linear = to_view @ matrix[:3, :3]
    # The camera is subtracted from the object's origin before the float32 positions are added: far from the
    # world's origin this keeps their digits.
    origin = to_view @ (matrix[:3, :3] @ surfels.origin + matrix[:3, 3] - camera.matrix_world[:3, 3])
    center = surfels.positions.astype(np.float64) @ linear.T + origin
    u, v = (axis.astype(np.float64) @ linear.T for axis in surfels.half_axes())
    plane = np.cross(u, v)
    # Mirrored objects turn u x v inside out.
    orientation = -1 if np.linalg.det(linear) < 0 else 1
    cosine = _outward_cosine(orientation * plane, center, camera)
    outward, *along = (orientation * of @ _cofactors(linear).T for of in _outward_normals(surfels))
    side, length = np.where(cosine < 0, -1, 1)[:, None], np.linalg.norm(outward, axis=1, keepdims=True)
    normal, *normal_along = (side * of / length for of in (outward, *along))
    color = surfels.colors[:, :3].astype(np.float64)
    uvs = _no_uvs(len(surfels))
    if instance.is_textured:
        border = uvs[2] if surfels.uv_border is None else surfels.uv_border.astype(np.float64)
        uvs = surfels.uvs.astype(np.float64), np.stack([surfels.uv_along_x, surfels.uv_along_y], axis=1), border
    textures = surfel_textures(instance)
    count = len(surfels)
    opacity, is_transparent = np.ones(count), np.full(count, instance.lets_through)
    if instance.lets_through:
        opacity = np.clip(surfels.colors[:, 3].astype(np.float64), 0, 1)
    blend = np.full(count, np.inf) if surfels.blend_depth is None else surfels.blend_depth.astype(np.float64)
    clip, reflex = surfels.clip_lines()
    splats = Splats(
        center=center,
        u=u,
        v=v,
        plane=plane,
        normal=normal,
        color=color,
        surface=_surface(instance, with_finish),
        is_back=cosine < 0,
        texture=textures,
        uv=uvs[0],
        uv_along=uvs[1],
        uv_border=uvs[2],
        clip=clip,
        reflex=reflex,
        blend=blend,
        opacity=opacity,
        is_transparent=is_transparent,
        is_holdout=np.full(count, instance.is_holdout),
        offset=np.zeros(count),
        normal_along=np.stack(normal_along, axis=1),
    )
    is_seen = cosine >= 0
    if not instance.hides_backs(camera):
        is_seen |= instance.lets_through or field_values(surfels, "hidden_back") < HIDDEN
    return splats if is_seen.all() else splats.take(np.flatnonzero(is_seen))


def _no_splats(columns: int) -> Splats:
    """columns: of their `surface`."""
    shapes = {"surface": (columns,), "uv": (2,), "uv_along": (2, 2), "uv_border": (2,)}
    shapes |= {"clip": (2, 3), "normal_along": (2, 3)}
    shapes |= dict.fromkeys(("center", "u", "v", "plane", "normal", "color"), (3,))
    types = {"texture": object} | dict.fromkeys(("is_back", "reflex", "is_transparent", "is_holdout"), bool)
    return Splats(**{f.name: np.zeros((0, *shapes.get(f.name, ())), types.get(f.name, float)) for f in fields(Splats)})


def _no_uvs(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    return np.zeros((count, 2)), np.zeros((count, 2, 2)), np.zeros((count, 2))


def _cofactors(linear: np.ndarray) -> np.ndarray:
    """The cofactor matrix: det(linear) times the inverse transpose, and defined for singular maps too.

    It carries normals just as well, but for the sign of the factor.
    """
    x, y, z = linear.T
    return np.stack([np.cross(y, z), np.cross(z, x), np.cross(x, y)], axis=1)


def _outward_cosine(outward: np.ndarray, center: np.ndarray, camera: Camera) -> np.ndarray:
    """(N,) cosine between each splat's outward side and the direction to the viewer."""
    to_eye = np.broadcast_to((0.0, 0.0, 1.0), center.shape) if camera.is_orthographic else -center
    lengths = np.linalg.norm(outward, axis=1) * np.linalg.norm(to_eye, axis=1)
    dot = np.einsum("ij,ij->i", outward, to_eye)
    return np.divide(dot, lengths, out=np.zeros_like(dot), where=lengths > 0)


def _outward_normals(surfels: Surfels) -> list[np.ndarray]:
    """(N, 3) shading normals on the outward side of the splats' planes, and their change along both half-axes, object
    space.

    They are turned before the object is placed, as stretching may carry a normal across its plane.
    """
    u, v = (axis.astype(np.float64) for axis in surfels.half_axes())
    normals = surfels.normals.astype(np.float64)
    side = np.where(np.einsum("ij,ij->i", normals, np.cross(u, v)) < 0, -1, 1)[:, None]
    return [side * normals, *(side * of.T for of in changes(surfels.arrays(), (unit(u).T, unit(v).T)))]


def has_finish(scene: Scene) -> bool:
    """Whether any surface has a finish."""
    return any(material.finish.layers for placed in scene.shown for material in placed.materials)


def material_table(placed: Placed, with_finish: bool) -> np.ndarray:
    """(M, 6 + 4 + F) roughness, metallic, f0, emission, light set and, if wanted, finish of each of its slots."""
    light_set = np.eye(MAX_LIGHT_SETS)[placed.light_set]
    rows = [
        (m.roughness, m.metallic, ((m.ior - 1) / (m.ior + 1)) ** 2, *m.emission, *light_set)
        + m.finish.numbers * with_finish
        for m in placed.materials
    ]
    return np.array(rows)


def _surface(instance: Instance, with_finish: bool) -> np.ndarray:
    """(N, 10 + F) `Splats.surface`: its own values, or its material's."""
    surfels = instance.surfels
    table = material_table(instance, with_finish)
    surface = table[np.minimum(surfels.materials, len(table) - 1)]
    for columns, own in ((0, surfels.roughness), (1, surfels.metallic), (slice(3, 6), surfels.emission)):
        if own is not None:
            surface[:, columns] = own
    return surface


def projected_bounds(splats: Splats, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """Boxes on the camera's window plane that hold the projected ellipses: two (N, 2) arrays, low and high.

    Exact for a splat in front of the near plane (centre-relative homography, the
    extrema of m + (a cos + b sin) / (1 + g cos + h sin)); everything for one that touches it; empty
    (low > high) for one that lies wholly before near or beyond far.
    """
    depth = -splats.center[:, 2]
    reach = np.hypot(splats.u[:, 2], splats.v[:, 2])
    # Boxes of splats that touch the near plane come out meaningless, and are replaced below.
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        middle, half = (_orthographic_boxes if camera.is_orthographic else _perspective_boxes)(splats, depth)
        # Rounding must not lose a ray at the rim.
        half = half * (1 + 1e-9) + 1e-12 * np.abs(middle)
        low, high = middle - half, middle + half
    if not camera.is_orthographic:
        everything = depth - reach * (1 + 1e-9) <= camera.near
        low[everything], high[everything] = -np.inf, np.inf
    outside = (depth + reach < camera.near * (1 - 1e-9)) | (depth - reach > camera.far * (1 + 1e-9))
    low[outside], high[outside] = np.inf, -np.inf
    return low, high


def _orthographic_boxes(splats: Splats, depth) -> tuple[np.ndarray, np.ndarray]:
    return splats.center[:, :2], np.hypot(splats.u[:, :2], splats.v[:, :2])


def _perspective_boxes(splats: Splats, depth) -> tuple[np.ndarray, np.ndarray]:
    scale = 1 / depth[:, None]
    middle = splats.center[:, :2] * scale
    g, h = -splats.u[:, 2:] * scale, -splats.v[:, 2:] * scale
    a, b = splats.u[:, :2] * scale - middle * g, splats.v[:, :2] * scale - middle * h
    spread = 1 - g * g - h * h
    offset = -(a * g + b * h) / spread
    return middle + offset, np.sqrt(offset * offset + (a * a + b * b) / spread)
