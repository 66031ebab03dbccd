# SPDX-License-Identifier: GPL-3.0-or-later
"""Where a scene's probes are: where the user chose, and in the middle of each other glossy object."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..scene import Scene
from ..scene.camera import Camera
from ..scene.light_probe import LightProbe
from ..scene.material import Material, reflectance
from ..scene.table import InstanceTable

#: A picture's probes; of more glossy objects, the largest have one.
MAX_PROBES = 8
#: A dielectric rougher than this, or one that reflects less at normal incidence, shows the world alone.
_ROUGHEST, _LEAST_REFLECTANCE = 0.4, 0.01
#: A metal of at least this share is glossy, however rough it is.
_LEAST_METALLIC = 0.5
#: A coat on less than this share of a surface shows the world alone.
_LEAST_COAT = 0.05
#: Of what is flatter than this share of its length, each place sees something else.
FLATTEST = 0.02


@dataclass(frozen=True)
class Probe:
    """middle: (3,) world. axes: (3, 3) rows, half-axes of the box that uses it, world. left_out: rows of the scene's
    table that its picture lacks. roughness: the least of what uses it. sees_others: whether anything glossy that is
    not flat is in its picture."""

    middle: tuple[float, ...]
    axes: tuple[tuple[float, ...], ...]
    left_out: tuple[int, ...]
    roughness: float
    sees_others: bool = False

    def pixels(self, camera: Camera) -> float:
        """How many pixels the box is wide, at most."""
        length = 2 * float(np.linalg.norm(self.axes, axis=1).max()) * camera.pixels_per_unit()
        if camera.is_orthographic:
            return length
        away = float(np.linalg.norm(camera.matrix_world[:3, 3] - self.middle))
        return length / max(away - self.radius, away / 4, 1e-30)

    @property
    def radius(self) -> float:
        """The radius of a ball around the box."""
        return float(np.linalg.norm(np.abs(self.axes).sum(axis=0)))


def glossy(table: InstanceTable) -> np.ndarray:
    """(n,) bool: which objects show their surroundings."""
    return table.of_kinds(lambda placed: placed.is_seen and _least_roughness(placed) <= 1)


def probes_of(scene: Scene, camera: Camera) -> tuple[tuple[Probe, ...], int]:
    """The probes, and the number of glossy objects or light probes that have none. An object whose middle is in the box
    of a light probe has no other."""
    table = scene.table
    are_glossy = glossy(table)
    if not are_glossy.any():
        return (), 0
    middles, axes = boxes(table)
    lengths = np.linalg.norm(axes, axis=2)
    radii = lengths.max(axis=1)
    is_round = (lengths.min(axis=1) > FLATTEST * radii) & ~table.are_flattened
    mirrors = set(np.flatnonzero(are_glossy & is_round).tolist())
    for chosen in scene.light_probes:
        is_round &= ~_are_in(middles, chosen.middle, np.array(chosen.axes))
    rows = np.flatnonzero(are_glossy & is_round)
    # polygons and surfels of a split object have one together
    rows = rows[np.unique(np.concatenate([middles, axes.reshape(-1, 9)], axis=1)[rows], axis=0, return_index=True)[1]]
    largest = rows[np.argsort(-radii[rows], kind="stable")]
    found = [_chosen(table, probe, are_glossy, middles, axes, radii) for probe in scene.light_probes]
    found += [_probe(table, int(row), middles, axes, radii, camera) for row in largest]
    # a surface uses the first one whose box holds it
    kept = sorted(found[:MAX_PROBES], key=lambda probe: probe.radius)
    kept = (replace(probe, sees_others=bool(mirrors.difference(probe.left_out))) for probe in kept)
    return tuple(kept), max(len(found) - MAX_PROBES, 0)


def _chosen(table: InstanceTable, probe: LightProbe, are_glossy: np.ndarray, middles, axes, radii) -> Probe:
    """The probe at a place that the user chose. What is glossy and around it is left out if it is smaller than its
    box."""
    least = min(_least_roughness(table.placed[row]) for row in np.flatnonzero(are_glossy).tolist())
    smaller = are_glossy & (np.abs(np.linalg.det(axes)) > 0) & (radii < np.linalg.norm(probe.axes, axis=1).max())
    point = np.array([probe.middle])
    around = [row for row in np.flatnonzero(smaller).tolist() if _are_in(point, middles[row], axes[row])[0]]
    return Probe(probe.middle, probe.axes, tuple(around), least)


def _are_in(points: np.ndarray, middle, axes: np.ndarray) -> np.ndarray:
    """(n,) bool: which of (n, 3) points are in a box."""
    return (np.abs((points - middle) @ np.linalg.inv(axes)) < 1).all(axis=1)


def _probe(table: InstanceTable, row: int, middles, axes, radii, camera: Camera) -> Probe:
    """The probe of one object. What is smaller and has its middle in its box belongs to it and is left out too, but not
    if the camera is in it: a room keeps its furniture and its walls."""
    are_in = _are_in(middles, middles[row], axes[row]) & (radii <= radii[row])
    holds_camera = _are_in(camera.matrix_world[None, :3, 3], middles[row], axes[row])[0]
    left_out = () if holds_camera else tuple(np.flatnonzero(are_in).tolist())
    rows = tuple(tuple(axis) for axis in axes[row].tolist())
    return Probe(tuple(middles[row].tolist()), rows, left_out, _least_roughness(table.placed[row]))


def boxes(table: InstanceTable) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3) middles and (n, 3, 3) half-axes of boxes around the objects, world."""
    corners = table.world_corners
    return corners.mean(axis=1), (corners[:, [1, 2, 4]] - corners[:, :1]) / 2


def _least_roughness(placed) -> float:
    """The least of all its surfaces that show their surroundings; 2 if there are none."""
    if placed.is_holdout:
        return 2.0
    return min((_roughness_of(material, placed.shape) for material in placed.materials), default=2.0)


def _roughness_of(material: Material, shape) -> float:
    roughness, metallic = (
        (getattr(material, name),) * 2
        if (own := getattr(shape, name)) is None
        else (float(own.min()), float(own.max()))
        for name in ("roughness", "metallic")
    )
    found = 2.0
    if metallic[1] >= _LEAST_METALLIC or (
        roughness[0] <= _ROUGHEST and reflectance(material.ior) >= _LEAST_REFLECTANCE
    ):
        found = roughness[0]
    return min(found, material.finish.coat_roughness) if material.finish.coat >= _LEAST_COAT else found
