# SPDX-License-Identifier: GPL-3.0-or-later
"""What a frame needs, decided before anything is allocated: a pure function from scene, camera and settings.

Nothing exists on the device that the plan does not name, each entry has its reason, and what was left out has
one too: print the plan to read them.
"""

from __future__ import annotations

import math

from .camera import Camera
from .frame_plan import HELD_BY, TEXTURES, FramePlan, PlannedPass
from .identity import NUMBERED
from .layers import layer_outputs, layer_passes, layers_of, lit_rows
from .methods import Method, get_method
from .packing import shared_emission, shared_material
from .scene import Material, Scene
from .settings import Settings
from .shading_models import ShadingModel, get_shading_model
from .shadow import MAX_MAPS, ShadowMap, shadow_maps
from .splat_plan import rim_passes, splat_passes
from .storages import get_storage
from .view import DepthExtent, depth_extent, overlapping_radii

#: Colour textures that a target may have: as many as Blender's.
MAX_COLORS = 6

#: A target's edge in samples; a larger picture is rendered in tiles, so that memory stays below about 1 GB.
MAX_TARGET_EDGE = 4096

#: Up to this ratio of the farthest depth to the nearest, or of a parallel camera's depths to its window, the hardware's
#: depth resolves 128 / 2^24 = 8e-6 of it: 1.5 % of the epsilon of a splat as small as a pixel of a 1000-pixel picture.
MAX_HARDWARE_DEPTH_RATIO = 128

#: Up to this radius of a splat at distance 1 its corners may be moved back instead of every fragment.
MAX_HARDWARE_DEPTH_RADIUS = 0.25


def plan(
    scene: Scene, camera: Camera, settings: Settings, shadow_camera: Camera | None = None, is_added_up: bool = False
) -> FramePlan:
    """The passes that this picture needs.

    shadow_camera: to whose view shadow maps are fitted, if it is another, so that cameras which differ little share
    them. is_added_up: the picture is one of the samples of a view that refines. Raises ValueError for an unknown method
    or storage, and for multisampling with a method that does not work in space.
    """
    method = get_method(settings.method)
    if settings.multisampling and method.works_in != "space":
        raise ValueError(
            f"Method {method.name} works in the picture, where hardware multisampling sees nothing; set multisampling "
            "to 0 and use supersampling, or method quad."
        )
    model = get_shading_model(settings.shading)
    material, emission = shared_material(scene.shown), shared_emission(scene.shown)
    linear_depth, passes, features, maps, depth_range, left_out = False, (), (), (), (0.0, 1.0), []
    if not scene.shown:
        left_out.append(
            ("all other passes", "the scene has neither surfels nor polygons: the picture is its background")
        )
        if _shows_environment(scene, settings):
            outputs = _outputs(settings, left_out)
            passes = (PlannedPass("background", "the world is a picture", ("environment_image",), outputs),)
    else:
        extent = depth_extent(scene, camera, settings.epsilon)
        depth_range = extent.near, extent.far
        linear_depth, why_depth = _linear_depth(camera, extent)
        sums = _sums(scene, settings, model, material, emission, left_out)
        maps = _shadow_maps(scene, shadow_camera or camera, settings, model, left_out)
        polygons = _polygon_passes(scene, settings, method, sums, maps, left_out)
        unread = ("polygon_depth", "polygon_identity")
        kept = (*sums, *(name for p in polygons for name in p.writes if name not in unread))
        lines = _line_passes(settings, method, kept, left_out)
        reads = _read_by_shading(scene, model, kept, maps, left_out) + (("lines",) if lines else ())
        shadows = (_shadow_pass(scene, maps),) if maps else ()
        layers = layers_of(scene, settings, method, model, left_out)
        has_rows = method.filters_silhouettes and not layers
        first, *splats = splat_passes(scene, camera, settings, method, has_rows, why_depth, sums, left_out)
        passes = (
            *shadows,
            first,
            *rim_passes(settings, method),
            *layer_passes(layers, settings, method, model, sums, reads),
            *splats,
            *polygons,
            *lines,
            *_shading_passes(scene, settings, method, model, reads, layers, left_out),
        )
        _check_targets(passes)
        features = _splat_features(scene, extent, left_out) + _features(scene, settings, model, emission, left_out)
        features += _caster_features(scene, layers if maps else 0, left_out)
        if not linear_depth:
            left_out.append(("linear depth", why_depth))
        _say_what_surfels_lack(scene, camera, left_out)
    if is_added_up and passes:
        passes = (*passes, PlannedPass("accumulate", "a view refines while it rests", ("combined",), ("sample_sum",)))
    return FramePlan(
        _tiles(camera.size, _tile_edge(settings, method)),
        settings.supersampling,
        settings.method,
        settings.shading,
        settings.multisampling,
        bool(settings.multisampling and settings.sample_shading),
        get_storage(settings.storage).name,
        settings.accumulation,
        material,
        emission,
        linear_depth,
        passes,
        features,
        maps,
        depth_range,
        lit_rows(scene) if any("lit_splats" in p.writes for p in passes) else 0,
        math.ceil(settings.lines.reach) if settings.lines else 0,
        tuple(left_out),
    )


def _check_targets(passes: tuple[PlannedPass, ...]) -> None:
    """Raises ValueError for a pass of more textures than every device can draw into at once."""
    for planned in passes:
        written = [name for name in planned.writes if TEXTURES[name][0] != "DEPTH32F"]
        if len(written) > MAX_COLORS and planned.name != "start_layers":  # which clears one after the other
            raise ValueError(
                f"The {planned.name} pass would write {len(written)} textures at once ({', '.join(written)}), and "
                f"devices have room for {MAX_COLORS}. Leave Overdraw, indices and mattes out, or choose float32 sums."
            )


# What follows decides one thing each, and appends to `left_out` what it decided against.


def _sums(
    scene: Scene, settings: Settings, model: ShadingModel, material: Material | None, emission, left_out: list
) -> tuple[str, ...]:
    """What the attribute pass adds up."""
    sums = ["color_sum", "normal_sum"]
    if settings.accumulation == "float16":
        sums.append("depth_sum")
    else:
        left_out.append(("depth_sum", "float32 sums of normals have room for depths"))
    if "overdraw" in settings.outputs or "overdraw_sum" in model.sums:
        sums.append("overdraw_sum")
    else:
        left_out.append(("overdraw_sum", "nobody asks how many splats a sample is the mean of"))
    blind = "" if model.has_material else f"{model.name} shading does not look at materials"
    one_light = "all surfels send out the same light" + ("" if emission and any(emission) else ", none")
    is_linked = model.is_lit and any(light.receivers is not None for light in scene.lights)
    why_not = {
        "material_sum": blind or ("" if material is None else "all surfels have one material"),
        "emission_sum": blind or ("" if emission is None else one_light),
        "light_set_sum": "" if is_linked else "every light lights everything, or nothing is lit",
    }
    sums += [name for name, why in why_not.items() if not why]
    left_out += [(name, why) for name, why in why_not.items() if why]
    return tuple(sums)


def _polygon_passes(
    scene: Scene, settings: Settings, method: Method, sums: tuple[str, ...], maps: tuple[ShadowMap, ...], left_out: list
) -> tuple[PlannedPass, ...]:
    """What of polygons is kept beside the sums over splats, which shading joins with it."""
    if not scene.polygons:
        left_out.append(("polygons", "the scene has none"))
        return ()
    kept = ["polygon_color", "polygon_normal"]
    if {"material_sum", "light_set_sum"} & set(sums):
        kept.append("polygon_material")
    if "emission_sum" in sums:
        kept.append("polygon_emission")
    if method.works_in == "sprites" and set(NUMBERED) & set(settings.outputs):
        kept.append("polygon_identity")
    if maps:
        kept.append("polygon_plane")
    touching = len(overlapping_radii(scene))
    why = f"{len(scene.polygons)} instances are polygons, of which {touching} touch surfels and may blend with them"
    seen = ("seen_range",) if method.works_in == "picture" else ()
    return (PlannedPass("polygons", why, seen, (*kept, "polygon_depth")),)


def _line_passes(settings: Settings, method: Method, sums: tuple[str, ...], left_out: list):
    if settings.lines is None:
        left_out.append(("lines", "none are asked for"))
        return ()
    seen = ("seen_range",) if method.works_in == "picture" else ()
    known = "color_sum", "normal_sum", "depth_sum", "polygon_color", "polygon_normal"
    reads = (*(name for name in known if name in sums), *seen)
    return (
        PlannedPass("lines", "silhouettes and creases are drawn before their samples are mixed", reads, ("lines",)),
    )


def _shadow_maps(
    scene: Scene, camera: Camera, settings: Settings, model: ShadingModel, left_out: list
) -> tuple[ShadowMap, ...]:
    if not model.is_lit or not settings.shadow_resolution:
        left_out.append(("shadows", "they are switched off, or nothing is lit"))
        return ()
    maps, without = shadow_maps(scene, camera, settings.shadow_resolution)
    if without:
        left_out.append((f"shadows of {without} lights", f"there is room for {MAX_MAPS} maps"))
    if not maps:
        left_out.append(("shadows", "no light casts any that the picture shows"))
    return maps


def _shadow_pass(scene: Scene, maps: tuple[ShadowMap, ...]) -> PlannedPass:
    casting = len({made.light for made in maps})
    why = f"{casting} of {len(scene.lights)} lights cast shadows, through {len(maps)} maps"
    return PlannedPass("shadow_maps", why, (), ("shadow_depth",), is_shared=True)


def _read_by_shading(
    scene: Scene, model: ShadingModel, sums: tuple[str, ...], maps: tuple[ShadowMap, ...], left_out: list
) -> tuple[str, ...]:
    reads = [*sums, *model.tables]
    if not model.is_lit:
        left_out.append(("lights", f"{model.name} shading does not look at lights"))
    elif not scene.lights:
        left_out.append(("lights", "the scene has none"))
    else:
        reads.append("lights")
        if maps:
            reads += ["shadow_maps", "shadow_depth"]
    if model.has_world and scene.environment:
        reads += ["environment_image", "environment_levels"]
    if not scene.environment:
        left_out.append(("environment", "the world is even"))
    return tuple(reads)


def _shows_environment(scene: Scene, settings: Settings) -> bool:
    return scene.environment is not None and not settings.transparent_film


def _splat_features(scene: Scene, extent: DepthExtent, left_out: list) -> tuple[tuple[str, str], ...]:
    features = []
    split = sum(placed.split is not None for placed in scene.shown)
    if split:
        features.append(("SPLIT", f"{split} instances are polygons near the camera, or surfels beyond that"))
    else:
        left_out.append(("split objects", "all are drawn whole"))
    if extent.reaches_near:
        features.append(("STRADDLING", "splats that may reach the near plane are drawn in space"))
    else:
        left_out.append(("straddling splats", "none reaches the near plane"))
    return tuple(features)


def _features(
    scene: Scene, settings: Settings, model: ShadingModel, emission, left_out: list
) -> tuple[tuple[str, str], ...]:
    """What shaders do beside the least."""
    features = [*model.features]
    if settings.edge_threshold == 0:
        left_out.append(("edge threshold", "it is 0: whatever a splat reaches is covered"))
    elif get_method(settings.method).works_in != "space":
        left_out.append(("edge threshold", f"the weights of {settings.method} are smaller where it filters"))
    else:
        features.append(("EDGE_THRESHOLD", f"pixels whose weights sum to less than {settings.edge_threshold:g} fade"))
    if model.has_material and "diffuse_color" in settings.outputs:
        features.append(("METALS", "of its diffuse colour a surface shows what is not metal"))
    if model.is_lit and scene.lights and "shadow" in settings.outputs:
        features.append(("SHADOW_SHARE", "the share of the lights that arrives is asked for"))
    if model.has_material and emission is not None and any(emission):
        features.append(("EMISSION", "all surfels send out the same light"))
    cutting = sum(instance.is_holdout for instance in scene.shown)
    if cutting and get_method(settings.method).works_in == "sprites":
        left_out.append(("holdout", f"of {settings.method} objects that cut holes are drawn as others are"))
    elif cutting:
        features.append(("HOLDOUT", f"{cutting} of {len(scene.shown)} instances cut holes"))
    sized = model.is_lit * sum(light.is_sized for light in scene.lights)
    if sized:
        features.append(("SIZED_LIGHTS", f"{sized} of {len(scene.lights)} lights have a size"))
    elif model.is_lit and scene.lights:
        left_out.append(("sized lights", "every light is a point or a direction"))
    return tuple(features)


def _caster_features(scene: Scene, layers: int, left_out: list) -> tuple[tuple[str, str], ...]:
    """layers: that cast and receive shadows."""
    casting = sum(i.is_transparent and i.casts_shadow for i in scene.surfels) if layers else 0
    if casting:
        return (("SCREEN_DOOR", f"shadows of {casting} instances are as transparent as those"),)
    left_out.append(("transparent shadows", "nothing transparent casts any"))
    return ()


def _shading_passes(
    scene: Scene,
    settings: Settings,
    method: Method,
    model: ShadingModel,
    reads: tuple[str, ...],
    layers: int,
    left_out: list,
):
    """From sums to pixels: in one pass, or in two where silhouettes are filtered."""
    outputs = _outputs(settings, left_out)
    behind = ("environment_image",) if _shows_environment(scene, settings) else ()
    if layers:
        behind += ("peeled", *layer_outputs(settings))
    once = f"{model.name}, once a sample"
    if method.works_in != "sprites" and any(instance.is_holdout for instance in scene.shown):
        reads += ("visibility_depth",)
    if not method.filters_silhouettes:
        return (PlannedPass("shading", once, tuple(dict.fromkeys((*reads, *behind))), outputs),)
    kept = ("shaded", "surface", *(f"sample_{name}" for name in outputs if f"sample_{name}" in TEXTURES))
    seen = "visibility_depth" if layers else "row_depth"
    return (
        PlannedPass("sample_shading", once, reads, kept),
        PlannedPass("resolve", "silhouettes are filtered", (*kept, seen, "seen_range", *behind), outputs),
    )


def _outputs(settings: Settings, left_out: list) -> tuple[str, ...]:
    """What the last pass writes."""
    asked_for = {HELD_BY[name][0] for name in settings.outputs if name in HELD_BY}
    textures = dict.fromkeys(texture for texture, _ in HELD_BY.values())
    outputs = tuple(name for name in textures if name in {"combined", "depth"} | asked_for)
    left_out += [(name, "nothing that it holds is asked for") for name in textures if name not in outputs]
    return outputs


def _say_what_surfels_lack(scene: Scene, camera: Camera, left_out: list) -> None:
    solid = sum(placed.hides_backs(camera) for placed in scene.shown)
    if solid:
        left_out.append(("backs", f"{solid} of {len(scene.shown)} instances are solid"))


def _linear_depth(camera: Camera, extent: DepthExtent) -> tuple[bool, str]:
    """Whether fragments must write their own depth, which costs the early depth test, and why."""
    ratio, radius = extent.ratio, extent.radius
    if camera.is_orthographic:
        if ratio > MAX_HARDWARE_DEPTH_RATIO and extent.is_ahead:
            return True, f"what is seen is {ratio:.3g} windows deep, too much for the hardware's depth"
        return False, "an orthographic camera's depth is linear"
    if ratio > MAX_HARDWARE_DEPTH_RATIO:
        return True, f"far / near of what is seen is {ratio:.3g}, too much for the hardware's depth"
    if radius > MAX_HARDWARE_DEPTH_RADIUS:
        return True, f"a splat's radius may be {radius:.3g} of its distance, too much to move its corners back"
    return False, f"far / near of what is seen is {ratio:.3g} and the hardware's depth serves"


def _tile_edge(settings: Settings, method: Method) -> int:
    """In pixels: along it lie the samples, and the square root of the hardware's samples in each. To filter silhouettes
    takes half as many textures again.
    """
    room = 2 if method.filters_silhouettes else 1
    across = settings.supersampling * room * math.ceil(math.sqrt(max(settings.multisampling, 1)))
    return max(MAX_TARGET_EDGE // across, 1)


def _tiles(size: tuple[int, int], edge: int) -> tuple[tuple[int, int, int, int], ...]:
    width, height = size
    return tuple(
        (x, y, min(edge, width - x), min(edge, height - y))
        for y in range(0, height, edge)
        for x in range(0, width, edge)
    )
