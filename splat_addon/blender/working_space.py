# SPDX-License-Identifier: GPL-3.0-or-later
"""The file's working space: the primaries of every colour in Blender's data, by default Rec. 709.

Blender 5 has a setting for it; in any version, an OpenColorIO configuration may have another than Rec. 709. Files
outside Blender mean Rec. 709, so colours are converted on their way in and out. The matrices are Blender's own, asked
for with the unit colours, so that they are those of the configuration that it uses.
"""

from __future__ import annotations

import numpy as np
from mathutils import Color

from ..primaries import recolored
from ..surfels import Surfels

_XYZ = "xyz_d65"
_REC709 = "rec709_linear"


def to_xyz() -> np.ndarray:
    """(3, 3) float64, from the working space to CIE XYZ with the white point D65. It identifies the space."""
    return _matrix(f"from_scene_linear_to_{_XYZ}")


def luminance() -> tuple[float, float, float, float]:
    """Weights of a colour's red, green, blue and alpha that make its luminance, as in shaders."""
    return (*to_xyz()[1].tolist(), 0.0)


def from_rec709() -> np.ndarray:
    """(3, 3) float64, from linear Rec. 709 to the working space."""
    return _matrix(f"from_{_REC709}_to_scene_linear")


def is_rec709() -> bool:
    """Whether the working space is linear Rec. 709."""
    return np.array_equal(from_rec709(), np.eye(3))


def surfels_from_rec709(surfels: Surfels) -> Surfels:
    """The surfels of a file in the working space; the same object if that is Rec. 709."""
    return recolored(surfels, from_rec709())


def surfels_to_rec709(surfels: Surfels) -> Surfels:
    """The inverse of `surfels_from_rec709`."""
    return recolored(surfels, _matrix(f"from_scene_linear_to_{_REC709}"))


def _matrix(method: str) -> np.ndarray:
    """A conversion of `Color` as a matrix, from what it makes of the unit colours. Blender 4.5 goes by way of XYZ; its
    rounding must not change colours that stay as they are."""
    made = np.array([getattr(Color(unit), method)()[:] for unit in np.eye(3).tolist()], np.float64).T
    return np.eye(3) if np.allclose(made, np.eye(3), rtol=0, atol=1e-5) else made
