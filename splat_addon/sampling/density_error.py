# SPDX-License-Identifier: GPL-3.0-or-later
"""How far surfels are from their mesh at a density, and the density for an error, from what was measured.

`MEASURED` is the representation error of five meshes (a drilled plate, fandisk, a truck, spot, the armadillo) in
pictures of `SIZE` pixels along each side: the mean FLIP over the pixels that the mesh touches, between exact pictures
of the surfels and of the mesh, under the pixel filter where it is larger. `bench.py trade --pages` writes it. Typical
is the geometric mean of the meshes; the worst is the armadillo, whose detail is finer than a pixel. A mesh that is
larger in the picture has less detail a pixel, and is closer.
"""

from __future__ import annotations

import numpy as np

# measured
SIZE = 192
#: Pixels between surfels -> (typical, worst) FLIP.
MEASURED = {
    0.375: (0.0101, 0.0201),
    0.5: (0.0111, 0.0270),
    0.75: (0.0133, 0.0437),
    1.0: (0.0162, 0.0641),
    1.5: (0.0231, 0.0972),
    2.0: (0.0310, 0.1403),
    3.0: (0.0480, 0.2235),
}
# end

_PIXELS = np.array(list(MEASURED))
_TYPICAL, _WORST = np.array(list(MEASURED.values())).T

#: More than the relative error of single precision, in which Blender stores its properties.
_ROUNDING = 1e-6

#: The least and the largest typical error for which `pixels_for` knows a density.
LEAST_ERROR, LARGEST_ERROR = float(_TYPICAL[0]), float(_TYPICAL[-1])


def error_at(pixels: float) -> tuple[float, float] | None:
    """(typical, worst) FLIP of surfels that are this far apart; None beyond what was measured."""
    if not _PIXELS[0] * (1 - _ROUNDING) <= pixels <= _PIXELS[-1] * (1 + _ROUNDING):
        return None
    return tuple(float(np.exp(np.interp(np.log(pixels), np.log(_PIXELS), np.log(each)))) for each in (_TYPICAL, _WORST))


def pixels_for(error: float) -> float:
    """The pixels between surfels at which the typical FLIP is `error`. Raises ValueError for one that was not
    measured."""
    if not LEAST_ERROR <= error <= LARGEST_ERROR:
        raise ValueError(f"An error of surfels must be {LEAST_ERROR:g} to {LARGEST_ERROR:g} (FLIP), not {error:g}.")
    return float(np.exp(np.interp(np.log(error), np.log(_TYPICAL), np.log(_PIXELS))))
