# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of the GGX lobe for the principled shading, fitted by reference/brdf_fit.py."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np

LEAST_ROUGHNESS = 0.03


@cache
def brdf_table() -> np.ndarray:
    """(48, 32, 8) float32: by roughness (`LEAST_ROUGHNESS` to 1) and sqrt(1 - cosine to the viewer) (0 to 1).

    Entries xx, xz, zx and zz (yy is 1) of the transform from directions of the lobe, in the frame whose x is the
    view's direction along the surface and z the normal, to a clamped cosine (Heitz et al. 2016); then the parts of
    the directional albedo that F0 scales and that it does not (Karis 2013); x and z of the lobe's mean direction.
    """
    table = np.load(Path(__file__).with_name("brdf_table.npy"))
    table.flags.writeable = False
    return table


@cache
def edge_table() -> np.ndarray:
    """(48, 32) float32 from the same fit: the integral of c (1 - c)^6 over the lobe, where c is the cosine to the half
    vector.

    A metal's tint reduces its reflectance in proportion to this term (Kutz, Hasan, Edmondson 2021).
    """
    table = np.load(Path(__file__).with_name("edge_table.npy"))
    table.flags.writeable = False
    return table


def edge_texels() -> np.ndarray:
    """(48, 32, 4) float32: `edge_table` in the first channel, 0 in the others."""
    return np.pad(edge_table()[..., None], ((0, 0), (0, 0), (0, 3)))


def brdf_texels() -> np.ndarray:
    """(48, 64, 4) float32: the first four entries, and to their right the other four."""
    table = brdf_table()
    return np.ascontiguousarray(np.concatenate([table[..., :4], table[..., 4:]], axis=1))
