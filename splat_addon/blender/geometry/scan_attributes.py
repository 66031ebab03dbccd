# SPDX-License-Identifier: GPL-3.0-or-later
"""What scanners measure besides places and colours, as attributes of the surfels that were made of a scan's points."""

from __future__ import annotations

import bpy
import numpy as np

from ..ids import SCANNER_FLEW, SCANNER_PATH, TIME_START

#: Blender has no 64-bit numbers in attributes, so that times are counted from the first one.
_TIME = "gps_time"


def write_scan_attributes(mesh: bpy.types.Mesh, attributes: dict[str, np.ndarray], rows: np.ndarray) -> None:
    """Add attributes to a mesh of surfels, under another name if it has one of it: integers as INT, others as FLOAT.
    attributes: (N,) by name, of the points.
    rows: which point each surfel was made of."""
    for name, values in attributes.items():
        values = values[rows]
        if name == _TIME and len(values):
            finite = values[np.isfinite(values)]
            start = float(finite.min()) if len(finite) else 0.0
            mesh[TIME_START], values = start, values - start
        is_whole = values.dtype.kind in "iub"
        kind, dtype = ("INT", np.int32) if is_whole else ("FLOAT", np.float32)
        with np.errstate(over="ignore", invalid="ignore"):
            column = np.ascontiguousarray(values.astype(dtype))
        mesh.attributes.new(name, kind, "POINT").data.foreach_set("value", column)


def keep_scanner_path(mesh: bpy.types.Mesh, path: tuple[np.ndarray, bool] | None, origin: np.ndarray) -> None:
    """Keep what `interchange.scanner_path` found, in the mesh's space. origin: (3,) from which its positions count, in
    the path's coordinates."""
    for name in (SCANNER_PATH, SCANNER_FLEW):
        mesh.pop(name, None)
    if path is not None:
        places, mesh[SCANNER_FLEW] = path
        mesh[SCANNER_PATH] = (places - np.append(origin, 0.0)).ravel().tolist()


def scanner_path_of(mesh: bpy.types.Mesh) -> np.ndarray:
    """(n, 4) float64 places and times of the scanner in the mesh's space; none if they are not known."""
    values = np.ravel(mesh.get(SCANNER_PATH, ()))
    is_whole = len(values) % 4 == 0 and np.issubdtype(values.dtype, np.number) and np.isfinite(values).all()
    return values.astype(np.float64).reshape(-1, 4) if is_whole else np.empty((0, 4))
