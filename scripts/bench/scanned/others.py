# SPDX-License-Identifier: GPL-3.0-or-later
"""Surfels of a scan by this checkout, by other ones, and by Open3D, each of the others in a process of its own.

Each function returns the surfels, (M,) the points that they were made of, and the seconds of the clock and of the
processor.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from measuring.registry import SCRIPTS
from measuring.timing import both
from splat_addon.sampling import surfels_from_points
from splat_addon.surfels import Surfels

#: What runs in another checkout.
_CHECKOUT = """
import sys, numpy as np
from measuring.timing import both
from splat_addon.sampling import surfels_from_points
given = dict(np.load(sys.argv[1]))
if "scanners" not in (surfels_from_points.__kwdefaults__ or {}):
    given.pop("scanners", None)
seconds, (surfels, *_) = both(lambda: surfels_from_points(given.pop("points"), **given))
names = "positions", "rotations", "scales", "normals", "colors", "materials", "origin"
np.savez(sys.argv[2], seconds=seconds, **{name: getattr(surfels, name) for name in names})
"""

#: What runs beside Open3D: 24 neighbours, and a statistical filter of 20 neighbours and two standard deviations.
_OPEN3D = """
import sys, time, numpy as np, open3d
given = dict(np.load(sys.argv[1]))
clock, work = time.perf_counter(), time.process_time()
cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(given["points"]))
cloud, kept = cloud.remove_statistical_outlier(20, 2.0)
cloud.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(24))
if "scanners" not in given:
    cloud.orient_normals_consistent_tangent_plane(24)
normals, kept = np.asarray(cloud.normals), np.asarray(kept)
if "scanners" in given:
    towards = given["scanners"][kept] - given["points"][kept]
    normals = normals * np.where((normals * towards).sum(axis=1, keepdims=True) < 0, -1, 1)
seconds = time.perf_counter() - clock, time.process_time() - work
np.savez(sys.argv[2], seconds=seconds, kept=kept, normals=normals)
"""


def ours(scan, scanners, **options):
    seconds, (surfels, report) = both(lambda: surfels_from_points(scan.points, scanners=scanners, **options))
    return surfels, report.kept, seconds


def of_the_mesh(scan, scanners):
    """No strays, and the mesh's normals nearest to the noisy points: about the best that any method could find."""
    good = np.flatnonzero(~scan.is_stray)
    seconds, (surfels, report) = both(lambda: surfels_from_points(scan.points[good], scan.nearest[good]))
    return surfels, good[report.kept], seconds


def of_checkout(checkout: Path, scan, scanners):
    paths = os.pathsep.join((str(checkout.resolve()), str(SCRIPTS)))
    arrays = _run(sys.executable, _CHECKOUT, paths, scan, scanners)
    seconds, surfels = arrays.pop("seconds"), Surfels(**arrays)
    return surfels, cKDTree(scan.points).query(surfels.positions + surfels.origin)[1], seconds


def of_open3d(python: Path, scan, scanners):
    """Open3D finds normals, sides and strays; the radii are ours, outside of its time."""
    found = _run(python, _OPEN3D, "", scan, scanners)
    kept = found["kept"]
    surfels, report = surfels_from_points(scan.points[kept], found["normals"], isolated="keep")
    return surfels, kept[report.kept], found["seconds"]


def _run(python: str | Path, code: str, paths: str, scan, scanners) -> dict[str, np.ndarray]:
    """The arrays that a process leaves; paths: where it finds modules."""
    with tempfile.TemporaryDirectory() as folder:
        given, made = Path(folder) / "given.npz", Path(folder) / "made.npz"
        np.savez(given, points=scan.points, **({} if scanners is None else {"scanners": scanners}))
        subprocess.run([python, "-P", "-c", code, given, made], env={**os.environ, "PYTHONPATH": paths}, check=True)
        return dict(np.load(made))
