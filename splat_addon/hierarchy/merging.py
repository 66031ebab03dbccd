# SPDX-License-Identifier: GPL-3.0-or-later
"""Merges several surfels into one: position, ellipse and attributes.

The position is the centroid by area, the normal the mean, and the ellipse has the second moments of its children's.
They overlap like samples of a grid, by a factor of `SAMPLE_SIZE`, and so does the merged one. Colours are means in
linear light, weighted by opacity, so transmitted light is averaged too. If surfels have their own roughness, the
length lost by the mean shading normal is added to it (Toksvig, "Mipmapping Normal Maps", 2005); otherwise a pixel with
many surfels also shows the mean of their normals, and needs no correction.
"""

from __future__ import annotations

import numpy as np

from ..large_surfels import BLEND_STEPS, STEPS_OF_SAMPLES
from ..normal_fields import fields_of
from ..quaternions import axes_quaternions
from ..surfels import Surfels
from .bounds import Frame, bounds
from .families import for_children, largest, total
from .merged_lines import clip_fields, merged_lines
from .nodes import MEANS, MERGED_OVERLAP, Nodes, Table, cut_off
from .texture_places import along_axes, merged_places

#: Squared half-axis per variance of position: the variance of a cell is 1 / 12 of its squared edge.
_PER_VARIANCE = np.float32(12 * MERGED_OVERLAP**2)
#: The ellipse around a child's own cell, relative to its half-axes; the parent must cover it.
_CORE = np.float32(np.sqrt(0.5) / MERGED_OVERLAP)
#: Maximum widening to achieve that.
_MOST_WIDENED = np.float32(1.5)
#: Minimum ratio of the shorter to the longer half-axis.
_NARROWEST = np.float32(0.02)
#: The smallest blend depth: what lies behind a ridge must not show beside it from afar.
_LEAST_BLENDING = STEPS_OF_SAMPLES / BLEND_STEPS


def merged(children: Nodes, cell: float) -> Nodes:
    """The m merged parents of families of c children each, whose arrays are (..., c, m)."""
    areas = total(children["areas"])
    shares = children["areas"] / areas
    centre = total(children["positions"] * shares)
    offsets = children["positions"] - for_children(centre)
    normal = _unit_columns(total(children["normals"] * shares))
    frame = _ellipse(children, shares, offsets, normal)
    shading = total(children["shading"] * shares)
    length = np.sqrt(np.einsum("kn,kn->n", shading, shading))
    shading = np.where(length > 1e-3, shading / np.maximum(length, 1e-12), normal)
    colors = _colors(children, shares)
    values = {name: total(children[name] * shares) for name in (*MEANS, "lift") if name in children}
    if "roughness" in children:
        values["roughness"] = _roughness(children["roughness"], shares, length)
    if "changes" in children:
        axes = frame.first * frame.longest, frame.second * frame.shortest
        changes = np.concatenate(_changes(children, shares, offsets, axes, shading))
        values["changes"] = changes / np.maximum(length, 1e-3)
    if "uv" in children:
        values["uv"] = merged_places(children["uv"], shares, offsets, cell)
    lines = None
    if "lines" in children:
        lines = merged_lines(children, offsets, normal, cell)
        values["lines"] = np.concatenate(lines.planes)
        values["cut_off"] = cut_off(lines.planes, frame.first * frame.longest, frame.second * frame.shortest)
    return Nodes(
        {
            "positions": centre,
            "normals": normal,
            "first_axis": frame.first * frame.longest,
            "second_axis": frame.second * frame.shortest,
            "radii": frame.longest,
            "areas": areas,
            "materials": children["materials"][0],
            "shading": shading,
            "colors": colors,
            **bounds(children, offsets, frame, shading, colors, lines),
            **values,
        }
    )


def as_surfels(nodes: Table, like: Surfels) -> Surfels:
    """Merged nodes as surfels with the fields and the origin of `like`."""
    axes = [nodes.column(name) for name in ("first_axis", "second_axis")]
    lengths = np.stack([np.sqrt(np.einsum("kn,kn->n", axis, axis)) for axis in axes])
    x, y = (axis / length for axis, length in zip(axes, lengths, strict=True))
    fields = {name: nodes.column(name) for name in (*MEANS, "roughness") if name in nodes.widths}
    fields = {name: columns[0] if len(columns) == 1 else columns.T for name, columns in fields.items()}
    if "hidden_back" in fields:
        fields["hidden_back"] = np.minimum(fields["hidden_back"], 1)
    if "uv" in nodes.widths:
        fields |= along_axes(nodes.column("uv"), np.stack(axes))
    if "lines" in nodes.widths:
        fields |= clip_fields(nodes.column("lines"), np.stack(axes))
    if "changes" in nodes.widths:
        along = np.split(nodes.column("changes"), 2)
        fields |= fields_of(nodes.column("shading"), along, (x, y, nodes.column("normals")))
    if "lift" in nodes.widths:
        fields["lift"] = nodes.column("lift")[0] / lengths.max(axis=0)
    if like.blend_depth is not None:
        fields["blend_depth"] = np.minimum(_LEAST_BLENDING + 2 * nodes.column("off") / lengths[0], 1)
    return Surfels(
        positions=nodes.column("positions").T,
        rotations=axes_quaternions(x.T, y.T, nodes.column("normals").T),
        scales=lengths.T,
        normals=nodes.column("shading").T,
        colors=nodes.column("colors").T,
        materials=nodes.column("materials"),
        origin=like.origin,
        is_solid=like.is_solid,
        **fields,
    )


def _unit_columns(vectors: np.ndarray) -> np.ndarray:
    """Unit sums of normals. They all face one axis, so a sum cannot vanish."""
    return vectors / np.sqrt(np.einsum("kn,kn->n", vectors, vectors))


def _ellipse(children: Nodes, shares: np.ndarray, offsets: np.ndarray, normal: np.ndarray) -> Frame:
    """Ellipses from the second moments of the children, on the planes of the normals."""
    (u, v), d = children.axes, offsets
    across, along = _tangents(normal)
    moments = {}
    for i in range(3):
        for k in range(i, 3):
            each = u[i] * u[k] + v[i] * v[k] + _PER_VARIANCE * (d[i] * d[k])
            moments[i, k] = total(each * shares)

    def quadratic(a, b):
        return sum(a[i] * b[k] * moments[min(i, k), max(i, k)] for i in range(3) for k in range(3))

    aa, ab, bb = quadratic(across, across), quadratic(across, along), quadratic(along, along)
    middle, half = (aa + bb) / 2, np.hypot((aa - bb) / 2, ab)
    angle = 0.5 * np.arctan2(2 * ab, aa - bb)
    cosine, sine = np.cos(angle), np.sin(angle)
    first, second = cosine * across + sine * along, cosine * along - sine * across
    longest = np.sqrt(middle + half)
    shortest = np.maximum(np.sqrt(np.maximum(middle - half, 0)), _NARROWEST * longest)
    frame = Frame(normal, first, second, longest, shortest)
    wider = np.clip(largest(frame.reach(children, offsets, _CORE)), 1, _MOST_WIDENED)
    return Frame(normal, first, second, longest * wider, shortest * wider)


def _tangents(normal: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Two (3, m) unit vectors that make a right-handed frame with the normals (Duff et al. 2017)."""
    x, y, z = normal
    sign = np.where(z < 0, np.float32(-1), np.float32(1))
    a = -1 / (sign + z)
    b = x * y * a
    return np.stack([1 + sign * x * x * a, sign * b, -sign * x]), np.stack([b, sign + y * y * a, -y])


def _colors(children: Nodes, shares: np.ndarray) -> np.ndarray:
    """(4, m): the mean opacity, and colours weighted by opacity unless all are fully transparent."""
    if (children["colors"][3] == 1).all():
        result = np.ones((4, shares.shape[-1]), np.float32)
        result[:3] = total(children["colors"][:3] * shares)
        return result
    hiding = children["colors"][3] + np.float32(1e-6)
    result = total(np.concatenate([children["colors"][:3] * hiding, hiding[None]]) * shares)
    result[:3] /= result[3]
    result[3] -= np.float32(1e-6)
    return result


def _changes(children: Nodes, shares: np.ndarray, offsets: np.ndarray, axes, shading: np.ndarray) -> list[np.ndarray]:
    """Two (3, m) changes of the normal along the (3, m) half-axes: the linear field of least squares over the fields of
    all children, weighted by area. Both axes are principal ones of these areas, so that each is fitted by itself."""
    own, away = np.split(children["changes"], 2), children["shading"] - for_children(shading)
    result = []
    for axis in axes:
        square = np.einsum("kn,kn->n", axis, axis)
        along = for_children(axis / np.maximum(square, 1e-37))
        u, v, d = ((along * of).sum(axis=0) for of in (*children.axes, offsets))
        moment = total((u * u + v * v + _PER_VARIANCE * d * d) * shares)
        result.append(total((own[0] * u + own[1] * v + _PER_VARIANCE * away * d) * shares) / np.maximum(moment, 1e-12))
    return result


def _roughness(roughness: np.ndarray, shares: np.ndarray, length: np.ndarray) -> np.ndarray:
    """(1, m): alpha = roughness^2; alpha^2 is twice the variance of the slopes, to which that of the normals adds
    (1 - length) / length (Toksvig 2005)."""
    variance = (1 - np.minimum(length, 1)) / np.maximum(length, 1e-3)
    return np.minimum((total(roughness**4 * shares) + 2 * variance) ** 0.25, 1)
