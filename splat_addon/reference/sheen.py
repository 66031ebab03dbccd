# SPDX-License-Identifier: GPL-3.0-or-later
"""A layer of fibres, in plain numpy; the twin of shaders/lib/sheen.glsl.

Zeltner, Burley, Chiang 2022, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", by the rational
fits to its tables that MaterialX 1.39 publishes.
"""

from __future__ import annotations

import numpy as np

#: The least roughness of the fits.
LEAST_SHEEN_ROUGHNESS = 0.01


def sheen_albedo(cosine: np.ndarray, roughness: np.ndarray) -> np.ndarray:
    """(n,) albedo under a uniform world, by the cosine to the viewer (n,)."""
    y = roughness
    width = y * (0.0206607 + 1.58491 * y) / (0.0379424 + y * (1.32227 + y))
    middle = y * (-0.193854 + y * (-1.14885 + y * (1.7932 - 0.95943 * y * y))) / (0.046391 + y)
    offset = y * (0.000654023 + y * (-0.0207818 + 0.119681 * y)) / (1.26264 + y * (-1.92021 + y))
    away = (cosine - middle) / width
    return np.clip(np.exp(-0.5 * away**2) / (width * np.sqrt(2 * np.pi)) + offset, 0, 1)


def sheen_transform(cosine: np.ndarray, roughness: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(n,) a and b of the transform (a x + b z, a y, z) from directions of the lobe to a clamped cosine.

    Their frame has the view's direction along the surface as x, and the normal as z.
    """
    x, y = cosine, roughness
    a = (2.58126 * x + 0.813703 * y) * y / (1 + 0.310327 * x * x + 2.60994 * x * y)
    below = 0.0000254053 + 1.71228 * x - 1.71506 * x * y + 1.34174 * y * y
    return a, np.sqrt(np.maximum(1 - x, 0)) * (y - 1) * y**3 / below


def sheen_term(local: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n,) the lobe times the cosine in directions (n, 3) of that frame; its integral is 1 over the whole sphere."""
    bent = sheen_bent(local[:, None], a, b)[:, 0]
    square = np.einsum("ij,ij->i", bent, bent)
    return np.maximum(local[:, 2], 0) / np.pi * (a / np.maximum(square, 1e-30)) ** 2


def sheen_bent(local: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """(n, k, 3) vectors (n, k, 3) of that frame, transformed."""
    x, y, z = np.moveaxis(local, 2, 0)
    return np.stack([a[:, None] * x + b[:, None] * z, a[:, None] * y, z], axis=2)
