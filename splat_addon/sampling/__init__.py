# SPDX-License-Identifier: GPL-3.0-or-later
"""Sampling: a mesh becomes surfels by exact scan conversion onto a layered depth cube. Numpy only.

Flow: `options` (chosen by the user), `mesh` (usable triangles) -> `density`, `ldc` (grid, scan conversion, reduction)
-> `attributes` (ellipse, normal, material) -> `edges` (clip lines) -> `refine` (fewer surfels where the surface is
flat, extra ones where no ray hit) -> `Surfels`; `sample` runs these steps. `camera_density` finds the spacing that a
camera needs. `deform` lets surfels follow a mesh; points without faces become surfels in `points`.
"""

from ..images import Image
from .attributes.corners import corner_values, gloss_textures, normal_map_texture
from .attributes.repainting import Repainting, has_normal_map, places_in_triangles
from .blocks import Block, joined_blocks, read_block, read_request, sample_block, write_blocks
from .camera_density import NotSeenError, Outline, camera_spacing, least_camera_spacings, outline
from .deform.deforming import STRETCHED_SHARE, DeformingSurfels
from .density import grid_spacing, predict_count
from .density_error import LARGEST_ERROR, LEAST_ERROR, error_at, pixels_for
from .edges.borders import DEFAULT_CREASE_ANGLE
from .edges.edge_samples import edge_samples, joined_at_edges, transition_edges
from .ldc.reductions import DEFAULT_GRAZING_ANGLE, LEAST_GRAZING_ANGLE, REDUCTIONS, projected_area
from .materials.surfaces import Channel, Computed, NormalMap, Surface, Texture, VertexColors
from .mesh.cleaning import drop_unusable
from .mesh.joining import have_same_values, joined, transformed
from .mesh.solid import is_solid
from .mesh.strays import drop_strays
from .mesh.triangle_mesh import TriangleMesh
from .options import DEFAULT_SPLAT_SIZE, FLAT, PLAIN, SamplingOptions
from .points import PointsReport, surfels_from_points
from .progress import SamplingCancelled
from .refine.flat_extents import NO_FLAT_EXTENTS, UNKNOWN_FLAT_EXTENTS, FlatExtents, flat_extents
from .refine.flat_faces import is_plain
from .refine.tolerance import Tolerance
from .sample import Sampling, sample_mesh, sample_surface

__all__ = [
    "DEFAULT_CREASE_ANGLE",
    "DEFAULT_GRAZING_ANGLE",
    "DEFAULT_SPLAT_SIZE",
    "FLAT",
    "LARGEST_ERROR",
    "LEAST_ERROR",
    "LEAST_GRAZING_ANGLE",
    "NO_FLAT_EXTENTS",
    "PLAIN",
    "REDUCTIONS",
    "STRETCHED_SHARE",
    "UNKNOWN_FLAT_EXTENTS",
    "Block",
    "Channel",
    "Computed",
    "DeformingSurfels",
    "FlatExtents",
    "Image",
    "NormalMap",
    "NotSeenError",
    "Outline",
    "PointsReport",
    "Repainting",
    "Sampling",
    "SamplingCancelled",
    "SamplingOptions",
    "Surface",
    "Texture",
    "Tolerance",
    "TriangleMesh",
    "VertexColors",
    "camera_spacing",
    "corner_values",
    "drop_strays",
    "drop_unusable",
    "edge_samples",
    "error_at",
    "flat_extents",
    "gloss_textures",
    "grid_spacing",
    "has_normal_map",
    "have_same_values",
    "is_plain",
    "is_solid",
    "joined",
    "joined_at_edges",
    "joined_blocks",
    "least_camera_spacings",
    "normal_map_texture",
    "outline",
    "pixels_for",
    "places_in_triangles",
    "predict_count",
    "projected_area",
    "read_block",
    "read_request",
    "sample_block",
    "sample_mesh",
    "sample_surface",
    "surfels_from_points",
    "transformed",
    "transition_edges",
    "write_blocks",
]
