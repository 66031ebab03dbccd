# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluates a mesh's surfaces at samples: constants, textures averaged over a sample's footprint, vertex colours,
graphs of shading nodes, and shading normals with detail from normal maps."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from ...shading_nodes import Inputs, evaluate
from ...surfels import OPTIONAL_LAYOUT
from ..table import SampleTable
from .surfaces import WRAPS, Channel, Computed, NormalMap, Surface, Texture, VertexColors

#: The pixel of a normal map that leaves the normal unchanged.
_FLAT = np.array((0.5, 0.5, 1.0), np.float32)

#: Number of components of a colour.
_ROW = np.complex128

#: Number of components per layer of texture coordinates and of vertex colours.
_UV, _RGBA = 2, 4


@dataclass(frozen=True, eq=False)
class Samples:
    """Inputs for evaluating the materials of n samples.

    materials: (n,) integers. colors: (4 layers, n) interpolated vertex colours, or None. uvs: (2 layers, n), or None.
    uv_steps: (2, 2 layers, n) their change from a sample to the next column's and the next row's.
    tangents: (4 layers, n) interpolated tangents and signs of the bitangent, one set per uv layer, or None.
    color_steps: (2, 4 layers, n) as `uv_steps`, of the vertex colours; None: not known.
    """

    materials: np.ndarray
    colors: np.ndarray | None = None
    uvs: np.ndarray | None = None
    uv_steps: np.ndarray | None = None
    tangents: np.ndarray | None = None
    color_steps: np.ndarray | None = None

    def take(self, rows: np.ndarray) -> Samples:
        return Samples(*(None if a is None else a[..., rows] for a in (getattr(self, f.name) for f in fields(self))))


class MaterialSampler:
    """The surfaces of one mesh, ready to be evaluated.

    optional: fields of `OPTIONAL_LAYOUT` that vary over any of the surfaces.
    needs_colors, needs_color_steps, needs_uvs, needs_tangents: whether any surface reads them.
    has_graphs: whether nodes of several surfaces are evaluated.
    """

    def __init__(self, surfaces: tuple[Surface, ...]):
        self._surfaces = surfaces
        channels = [channel for surface in surfaces for channel in surface.channels().values()]
        factors = [factor for channel in channels for factor in channel.factors]
        textures = [factor for factor in factors if isinstance(factor, Texture)]
        self.optional = tuple(n for n in OPTIONAL_LAYOUT if any(_varies(getattr(s, n, None)) for s in surfaces))
        graphs = [factor.graph for factor in factors if isinstance(factor, Computed)]
        self.has_graphs = bool(graphs) and len(surfaces) > 1
        self.needs_colors = any(isinstance(f, VertexColors) for f in factors) or any(g.reads_colors for g in graphs)
        self.needs_color_steps = any(graph.reads_colors and graph.looks_beside for graph in graphs)
        self.needs_tangents = any(s.normal_map is not None and s.normal_map.space == "TANGENT" for s in surfaces)
        self.needs_uvs = bool(textures) or self.needs_tangents or any(graph.reads_uvs for graph in graphs)

    def fill(self, out: SampleTable, samples: Samples) -> None:
        """Write colours and optional fields, and apply normal maps to the shading normals already in `out`.

        out: fields of `Surfels` -> their rows of these samples. Non-finite values are replaced by the channel's
            constant.
        """
        if len(self._surfaces) == 1:
            return self._fill(out, slice(None), self._surfaces[0], samples)
        indices = np.minimum(samples.materials, len(self._surfaces) - 1)
        for index in np.unique(indices):
            at = np.flatnonzero(indices == index)
            self._fill(out, at, self._surfaces[index], samples.take(at))

    def _fill(self, out, at, surface: Surface, samples: Samples) -> None:
        looked_up: dict = {}
        colors = self._values(surface.color, samples, looked_up)
        # numpy is many times slower at broadcasting a row of four
        if colors.ndim == 1:
            out["colors"].view(_ROW)[at] = colors.view(_ROW)
        else:
            for k in range(4):
                out["colors"][at, k] = colors[:, k]
        if surface.opacity is not None:
            out["colors"][at, 3] *= self._values(surface.opacity, samples, looked_up)[..., 0]
        for name in self.optional:
            columns, _, default = OPTIONAL_LAYOUT[name]
            channel = getattr(surface, name)
            values = np.full(columns, default) if channel is None else self._values(channel, samples, looked_up)
            out[name][at] = values if columns > 1 else values[..., 0]
        if surface.normal_map is not None:
            color = self._values(surface.normal_map.color, samples, looked_up, _FLAT)
            out["normals"][at] = bent(out["normals"][at], surface.normal_map, color, samples.tangents)

    def _values(self, channel: Channel, samples: Samples, looked_up: dict, fallback=None) -> np.ndarray:
        """(n, k) float32, or (k,) if nothing varies. looked_up: lookups shared by the channels of this surface.

        fallback: used where the varying value is missing or not finite; None: use the channel's constant.
        """
        constant = np.asarray(channel.value, np.float32)
        factors = [self._factor(factor, len(constant), samples, looked_up) for factor in channel.factors]
        factors = [factor for factor in factors if factor is not None]
        fallback = constant if fallback is None or not channel.factors else fallback
        if not factors:
            return fallback
        values = math.prod(factors, start=constant)
        finite = np.isfinite(values)
        return values if finite.all() else np.where(finite.all(axis=1, keepdims=True), values, fallback)

    def _factor(self, factor, count: int, samples: Samples, looked_up: dict) -> np.ndarray | None:
        """(n, count) values of a factor; None if the mesh lacks its layer."""
        rgba = _READERS[type(factor)](self, factor, samples, looked_up)
        if rgba is None:
            return None
        if factor.weights is None:
            return rgba[:, :count]
        number = (rgba @ np.float32(factor.weights))[:, None]
        return np.concatenate([np.repeat(number, 3, axis=1), np.ones_like(number)], axis=1) if count == 4 else number

    def _vertex_colors(self, factor: VertexColors, samples: Samples, looked_up) -> np.ndarray | None:
        rows = _layer(samples.colors, factor.layer, _RGBA)
        if rows is None:
            return None
        if not factor.uses_alpha and factor.weights is None:
            rows = np.concatenate([rows[:3], np.ones_like(rows[3:])])
        return rows.T

    def _texture(self, factor: Texture, samples: Samples, looked_up) -> np.ndarray | None:
        placement = None if factor.placement is None else factor.placement.tobytes()
        key = factor.image, factor.layer, placement, factor.wraps
        if key not in looked_up:
            uvs, steps = placed(factor, samples)
            if uvs is None:
                return None
            pyramid = factor.image.pyramid
            looked_up[key] = pyramid.lookup(uvs, pyramid.level_for(_texels_between(steps, pyramid.size)))
        return looked_up[key] if factor.uses_alpha else _on_black(looked_up[key])

    def _computed(self, factor: Computed, samples: Samples, looked_up) -> np.ndarray:
        inputs = len(samples.materials), samples.uvs, samples.colors, samples.uv_steps, samples.color_steps
        values = evaluate(factor.graph, Inputs(*inputs))
        rgba = np.ones((4, inputs[0]), np.float32)
        rgba[:3] = values
        return rgba.T


_READERS = {
    VertexColors: MaterialSampler._vertex_colors,
    Texture: MaterialSampler._texture,
    Computed: MaterialSampler._computed,
}


def placed(texture: Texture, samples: Samples) -> tuple[np.ndarray | None, np.ndarray | None]:
    """(2, n) coordinates in the texture's image and their (2, 2, n) steps; None if the mesh lacks its layer."""
    uvs, steps = (_layer(a, texture.layer, _UV) for a in (samples.uvs, samples.uv_steps))
    if uvs is None:
        return None, None
    if texture.placement is not None:
        linear, shift = texture.placement[:, :2], texture.placement[:, 2:]
        uvs, steps = (linear @ uvs + shift).astype(np.float32), linear @ steps
    if texture.wraps is not None:
        uvs = np.stack([WRAPS[wrap](row) for wrap, row in zip(texture.wraps, uvs, strict=True)])
    return uvs, steps


def bent(normals: np.ndarray, normal_map: NormalMap, color: np.ndarray, tangents: np.ndarray | None) -> np.ndarray:
    """(n, 3) unit normals with a normal map applied, as Blender's Normal Map node does.

    normals: (n, 3) unit. color: (n, 3) or (3,), averaged: the mean direction over a footprint is the direction of its
        mean vector.
    tangents: (4 layers, n), or None. Without tangents, or where a tangent vanishes, a tangent-space map is ignored. In
        tangent space the strength scales the tangential components; in object space it blends with the normal.
    """
    vector = 2 * np.broadcast_to(color, normals.shape) - 1
    strength = normal_map.strength
    if normal_map.space == "TANGENT":
        tangent = _layer(tangents, normal_map.layer, 4)
        if tangent is None:
            return normals
        sign, tangent = tangent[3][:, None], tangent[:3].T
        across = vector[:, :2] * strength
        along = 1 + (vector[:, 2:] - 1) * min(strength, 1)
        result = across[:, :1] * tangent + across[:, 1:] * sign * np.cross(normals, tangent) + along * normals
    else:
        result = normals + (vector - normals) * strength
    length = np.linalg.norm(result, axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        result = result / length
    usable = np.isfinite(result).all(axis=1, keepdims=True) & (length > 1e-6)
    return np.where(usable, result, normals)


def _varies(channel: Channel | None) -> bool:
    return channel is not None and bool(channel.factors)


def _layer(rows: np.ndarray | None, layer: int, width: int) -> np.ndarray | None:
    """One layer of an array (..., layers * width, n); None if it does not exist."""
    if rows is None or rows.shape[-2] < (layer + 1) * width:
        return None
    return rows[..., layer * width : (layer + 1) * width, :]


def _on_black(rgba: np.ndarray) -> np.ndarray:
    """(n, 4) colours composited on black, as they appear where alpha is ignored."""
    alpha = rgba[:, 3:]
    return rgba if (alpha == 1).all() else np.concatenate([rgba[:, :3] * alpha, np.ones_like(alpha)], axis=1)


def _texels_between(uv_steps: np.ndarray, size: tuple[int, int]) -> np.ndarray:
    """(n,) pixels of a (width, height) image between a sample and its more distant neighbour in the grid."""
    width, height = size
    columns, rows = (np.hypot(du * width, dv * height) for du, dv in uv_steps)
    return np.maximum(columns, rows)
