# SPDX-License-Identifier: GPL-3.0-or-later
"""How a mesh is sampled that is rendered without a conversion, and how densely at its most demanding place."""

from __future__ import annotations

import math
from functools import partial

import bpy
import numpy as np

from ...rendering.contents import digest
from ...sampling import DeformingSurfels, NotSeenError, TriangleMesh, grid_spacing, projected_area
from ..conversion.automatic_density import automatic_spacing
from ..conversion.camera_density import most_demanding, seen_spacing
from ..density import Density, Measure
from .live_mesh import LiveMesh

#: A sampling is kept until it is coarser or finer than requested by more than this factor.
_TOO_COARSE, _TOO_FINE = 1.26, 2.5

#: Detail of an object outside the camera's view, whose light or shadow may still be visible.
_UNSEEN_RESOLUTION = 64


def deforming_surfels(
    mesh: TriangleMesh, spacing: float, looks: dict[str, bool], ends_at_edges: bool, bends: bool
) -> DeformingSurfels:
    """A mesh sampled as the operator does. ends_at_edges: False for a part of a mesh whose border continues as
    polygons. bends: whether planes that fit the mesh now will not fit it later.
    """
    edges = {} if ends_at_edges else {"crease_angle": None}
    if bends:
        edges["fits_planes"] = False
    return DeformingSurfels(mesh, spacing=spacing, deforms=bends, **looks, **edges)


def spacing_for(live: LiveMesh, density: Density, depsgraph: bpy.types.Depsgraph, views: tuple) -> float:
    """Spacing in a mesh's own units: as fine as its most demanding place requests, or unchanged if that is close
    enough, or if nothing changed. views: the cameras of the depsgraph, as a value."""
    if density != live.density:
        live.deforming = None
    asked = live.detail, digest(live.matrices), views
    if live.deforming is not None and live.settled[0] is live.read.whole and live.settled[1] == asked:
        return live.spacing
    spacing = _SPACINGS[density.measure](live, density.value, depsgraph)
    live.settled = live.read.whole, asked
    return spacing


def _kept_if_near(live: LiveMesh, spacing: float) -> float:
    is_near = live.deforming and spacing / _TOO_FINE <= live.spacing <= spacing * _TOO_COARSE
    return live.spacing if is_near else spacing


def _by_resolution(live: LiveMesh, resolution: float, depsgraph: bpy.types.Depsgraph) -> float:
    # deforming meshes keep their surfels, unless they are stretched too far
    return live.spacing if live.deforming else grid_spacing(live.read.whole, resolution=resolution)


def _by_spacing(live: LiveMesh, spacing: float, depsgraph: bpy.types.Depsgraph) -> float:
    stretch = float(np.linalg.svd(live.matrices[:, :3, :3], compute_uv=False).max())
    return _kept_if_near(live, spacing / stretch if stretch > 0 else math.inf)


def _by_camera(live: LiveMesh, pixels: float, depsgraph: bpy.types.Depsgraph) -> float:
    surface, spacings = live.read.outline, []
    for matrix in most_demanding(pixels, surface, live.matrices, depsgraph):
        try:
            spacings.append(seen_spacing(pixels, surface, matrix, depsgraph))
        except NotSeenError:
            continue
    if spacings:
        return _kept_if_near(live, min(spacings))
    return live.spacing if live.deforming else grid_spacing(live.read.whole, resolution=_UNSEEN_RESOLUTION)


def _by_itself(live: LiveMesh, pixels: float, depsgraph: bpy.types.Depsgraph) -> float:
    """The spacing that the most demanding place needs, within the limits of `automatic_density`; kept until it changes
    much."""
    mesh, surface = live.read.whole, live.read.outline
    # The detail is already in the pixels, but it also counts if no camera sees the mesh.
    asked = pixels * live.detail
    spacing = partial(automatic_spacing, asked, lambda: surface, projected_area(mesh), grid_spacing(mesh, resolution=1))
    matrices = most_demanding(asked, surface, live.matrices, depsgraph)
    return _kept_if_near(live, min(spacing(matrix, depsgraph, detail=live.detail).spacing for matrix in matrices))


#: what is counted -> function of a mesh, the number and the depsgraph that returns the spacing
_SPACINGS = {
    Measure.RESOLUTION: _by_resolution,
    Measure.SPACING: _by_spacing,
    Measure.PIXELS: _by_camera,
    Measure.AUTOMATIC: _by_itself,
}
