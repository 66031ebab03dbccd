# SPDX-License-Identifier: GPL-3.0-or-later
"""Representation error: how close pictures of surfels are to the mesh that they were made from.

The reference is rendered from the mesh's triangles in float64 with 8 x 8 samples per pixel and a Gaussian filter of
sigma 0.7071 pixels; it shares no code with surfels. Meshes are coloured by their normals, split at creases over 30
degrees, unlit, on a grey background of 0.05, and seen from three directions at 1.4 diagonals of their boxes. "engine":
surfels as the operator makes them, drawn by the device; "whole": the same without clip lines, blend depths and fitted
planes; "polygons": the mesh itself, drawn by the engine without surfels. The others are exact pictures (--exact): "now"
of whole splats; "clip" with clip lines; "blend" with a blend depth per surfel; "both"; "fit" in fitted planes, too;
"flat" with large surfels inside flat faces, as "engine" has.
PSNR is measured in sRGB. A pixel is wrong if a component differs by more than 0.15; bare if the mesh covers it fully
and the surfels less than 0.98; spilled if the surfels cover more than 0.02 of it and the mesh nothing. Conversion:
median ratios of its time to that without edges, by the processor's and by the clock. Frame: median ratio of the
processor time of a frame to that of whole surfels.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from bench.representation import lit, points
from bench.representation.error import over_grey, picture_error
from bench.representation.meshes import load_colored, view
from measuring.models import short
from measuring.timing import Spread, both, in_turn, processor
from splat_addon.reference import render_exact
from splat_addon.reference.triangles import render_triangles
from splat_addon.rendering import PolygonInstance, Renderer, Scene, Settings, make_polygons, open_device
from splat_addon.sampling import DEFAULT_CREASE_ANGLE, FLAT, PLAIN, camera_spacing, is_solid, outline, sample_surface

DEVICES = ("standalone",)
QUICK = {"size": 48, "resolution": [24], "model": ["plate"], "views": 1, "exact": 2}
MODELS = "plate", "fandisk.obj.gz", "truck.obj.gz", "armadillo.obj.gz", "bunny.obj.gz", "rangemap_lato315.ply.gz"
SETTINGS = Settings(shading="flat", transparent_film=True)

#: name -> options of `sample_surface`
KINDS = {
    "now": PLAIN,
    "clip": PLAIN | {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_blending": False},
    "blend": PLAIN | {"fits_blending": True, "fits_planes": False},
    "both": PLAIN | {"crease_angle": DEFAULT_CREASE_ANGLE, "fits_planes": False},
    "fit": PLAIN | {"crease_angle": DEFAULT_CREASE_ANGLE},
    "flat": PLAIN | {"crease_angle": DEFAULT_CREASE_ANGLE, "tolerance": FLAT},
}
COLUMNS = "model resolution view picture PSNR FLIP FLIP_99_% largest_blob wrong bare spilled".replace("_", " ").split()


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=384, help="pixels along each side")
    parser.add_argument("--resolution", type=int, nargs="*", default=[256], help="cells along the longest edge")
    parser.add_argument("--pixels", type=float, nargs="*", default=[], help="between surfels in the nearest view, too")
    parser.add_argument("--model", nargs="+", default=MODELS, help="files among the models, or a name in meshes.py")
    parser.add_argument("--views", type=int, default=3, choices=(1, 2, 3))
    parser.add_argument("--samples", type=int, default=1, help="pictures whose mean the engine shows; F12 has 16")
    parser.add_argument("--tolerance", type=float, default=1.0, help="Detail Tolerance, in pixels")
    parser.add_argument("--exact", type=int, default=0, help="samples along a pixel of exact pictures; 0 for none")
    parser.add_argument("--lit", action="store_true", help="measure lit pictures with changing normals instead")
    parser.add_argument("--fitted", action="store_true", help="lit pictures of normals that are fitted, too")
    parser.add_argument("--points", type=int, default=0, help="measure random points of this number instead")
    parser.add_argument("--noise", type=float, nargs="+", default=[0.0], help="of points, in spacings")
    parser.add_argument("--kind", nargs="+", default=list(KINDS), choices=KINDS, help="of exact pictures")


def run(options, report) -> None:
    renderer = Renderer(open_device(options.device))
    exact = f"exact pictures of {options.exact} x {options.exact} samples" if options.exact else "no exact pictures"
    report.header(renderer.device, f"{options.size} x {options.size} pixels; {exact}")
    meshes = {name: load_colored(options.models, name) for name in options.model}
    if options.lit:
        report.table(lit.COLUMNS, lit.rows(meshes, renderer, options))
        return
    if options.points:
        report.table(points.COLUMNS, points.rows(meshes, renderer, options, report))
        return
    report.table(COLUMNS, rows(meshes, renderer, options, report))
    columns = "model", "resolution", "kind", "surfels", "added", "lines", "two", "reflex", "work", "clock"
    report.table(columns, conversions(meshes, options))
    report.table(("model", "resolution", "view", "frame"), frames(meshes, renderer, options))


def converted(mesh, density: dict, kind: str):
    surfels = sample_surface(mesh, **density, **KINDS[kind]).surfels
    return surfels.as_solid() if is_solid(mesh) else surfels


def densities(mesh, cameras, options) -> dict[str, dict]:
    """name -> fineness: resolutions, and spacings in pixels of the closest view."""
    found, surface = {str(resolution): {"resolution": resolution} for resolution in options.resolution}, outline(mesh)
    for pixels in options.pixels:
        near = min(
            camera_spacing(
                surface, pixels, object_to_view=camera.world_to_view(), window=camera.window, size=camera.size,
                near=camera.near, is_orthographic=False,
            )
            for camera in cameras
        )  # fmt: skip
        found[f"{pixels:g} px"] = {"spacing": near}
    return found


def rows(meshes, renderer, options, report):
    for name, mesh in meshes.items():
        cameras = [view(mesh, k, options.size) for k in range(options.views)]
        corners, colors = mesh.positions[mesh.triangles], mesh.corner_colors[..., :3]
        truths = [render_triangles(corners, colors, camera) for camera in cameras]
        for resolution, density in densities(mesh, cameras, options).items():
            drawn = {"engine": "flat", "whole": "now"}
            scenes = {shown: Scene((converted(mesh, density, kind),)) for shown, kind in drawn.items()}
            scenes["polygons"] = Scene(polygons=(PolygonInstance(polygons(mesh)),))
            settings = replace(SETTINGS, samples=options.samples, detail_tolerance=options.tolerance)
            draw = dict.fromkeys(scenes, partial(renderer.render, settings=settings))
            for kind in options.kind if options.exact else ():
                scenes[kind] = Scene((converted(mesh, density, kind),))
                how = {"settings": SETTINGS, "samples": options.exact, "pixel_filter": "gaussian"}
                draw[kind] = partial(render_exact, **how)
            for kind, scene in scenes.items():
                for k, (camera, truth) in enumerate(zip(cameras, truths, strict=True)):
                    color = draw[kind](scene, camera).color
                    shown = over_grey(color[..., :3], color[..., 3]), over_grey(truth.color, truth.coverage)
                    found = picture_error(*shown, color[..., 3], truth.coverage)
                    report.picture(
                        f"{short(name)}_{resolution}_{k}_{kind}".replace(" ", ""), [*shown, found.difference]
                    )
                    yield (
                        short(name), resolution, k, kind, f"{found.psnr:.1f}", f"{found.flip:.4f}",
                        f"{found.flip_99:.3f}", found.blob, found.wrong, found.bare, found.spilled,
                    )  # fmt: skip


def polygons(mesh):
    colors = mesh.corner_colors.reshape(-1, 4)
    return make_polygons(mesh.positions, mesh.triangles, mesh.corner_normals, colors=colors)


def conversions(meshes, options):
    for name, mesh in meshes.items():
        for resolution in options.resolution:
            jobs = {k: partial(sample_surface, mesh, resolution=resolution, **KINDS[k]) for k in options.kind}
            now = jobs.get("now", partial(converted, mesh, {"resolution": resolution}, "now"))
            turns = in_turn({"now": now} | jobs, options.turns, both)
            for kind in options.kind:
                sampling, (lines, reflex) = turns.results[kind], turns.results[kind].surfels.clip_lines()
                cut = lines[..., 2] < 1
                clock, work = (Spread.of(turns.part(lambda pair, k=k: pair[k]).ratios(kind, "now")) for k in (0, 1))
                yield (
                    short(name), resolution, kind, f"{len(sampling.surfels):,}", sampling.gaps,
                    f"{cut.any(axis=1).sum():,}", f"{cut.all(axis=1).sum():,}", f"{reflex.sum():,}", f"{work:.2f}",
                    f"{clock:.2f}",
                )  # fmt: skip


def frames(meshes, renderer, options):
    for name, mesh in meshes.items():
        for resolution in options.resolution:
            scenes = {kind: Scene((converted(mesh, {"resolution": resolution}, kind),)) for kind in ("now", "flat")}
            for k in range(options.views):
                camera = view(mesh, k, options.size)
                jobs = {kind: partial(renderer.render, scene, camera, SETTINGS) for kind, scene in scenes.items()}
                ratios = in_turn(jobs, options.turns, processor).ratios("flat", "now")
                yield short(name), resolution, k, f"{Spread.of(ratios).median:.2f}"
