# SPDX-License-Identifier: GPL-3.0-or-later
"""The fields of surfels: names, columns, types and defaults."""

from __future__ import annotations

import numpy as np

#: field -> (columns, dtype); one column is stored flat.
LAYOUT = {
    "positions": (3, np.float32),
    "rotations": (4, np.float32),
    "scales": (2, np.float32),
    "normals": (3, np.float32),
    "colors": (4, np.float32),
    "materials": (1, np.int32),
}

#: Optional fields, None where the scene does not need them: field -> (columns, dtype, default). The default, one number
#: for all columns, is what a set without the field means: Principled's own default, or no texture.
OPTIONAL_LAYOUT = {
    "roughness": (1, np.float32, 0.5),
    "metallic": (1, np.float32, 0.0),
    "emission": (3, np.float32, 0.0),
    "uvs": (2, np.float32, 0.0),
    "uv_along_x": (2, np.float32, 0.0),
    "uv_along_y": (2, np.float32, 0.0),
    "uv_border": (2, np.float32, 0.0),
    "clip_line": (2, np.int16, 0),
    "clip_line_2": (2, np.int16, 0),
    "blend_depth": (1, np.float32, 1.0),
    "lift": (1, np.float32, 0.0),
    "hidden_back": (1, np.float32, 0.0),
    "normal_along_x": (2, np.int16, 0),
    "normal_along_y": (2, np.int16, 0),
}

#: Minimum alpha of an opaque surfel: filtering an image of ones can leave alpha slightly below 1.
OPAQUE = 0.999

#: Minimum of `Surfels.hidden_back` of a surfel that is not drawn from behind; a mean of ones can be slightly below 1.
HIDDEN = 0.999
