# SPDX-License-Identifier: GPL-3.0-or-later
"""Ten node trees of the kinds that downloaded files have, each before Base Color, Roughness and Normal."""

from __future__ import annotations

from .chains import Chain, Socket

Inputs = dict[str, Socket]


def texture_set(c: Chain) -> Inputs:
    """Colour times occlusion, glossiness turned into roughness, a normal map."""
    color = c.mix(1.0, c.image("color"), c.image("occlusion"), "MULTIPLY")
    hue = c.add("HueSaturation", {"Saturation": 1.15, "Value": 0.95, "Color": color}).outputs[0]
    parts = c.add("SeparateColor", {0: c.image("packed")}).outputs
    normal = c.add("NormalMap", {"Strength": 0.8, "Color": c.image("normal")}).outputs[0]
    return {"Base Color": hue, "Roughness": c.math("SUBTRACT", 1.0, parts["Green"]), "Normal": normal}


def grunge(c: Chain) -> Inputs:
    """Clean and dirty paint, mixed by noise and an image."""
    at = c.coordinates("Object")
    dirt = c.mix(0.5, c.mask(c.noise(at, 2.0, 6.0), 0.4, 0.65), c.image("grunge"), "MULTIPLY")
    color = c.mix(dirt, c.image("print"), (0.09, 0.06, 0.04, 1))
    rough = c.add("MapRange", {"Value": dirt, "To Min": 0.25, "To Max": 0.9}).outputs[0]
    return {"Base Color": color, "Roughness": rough, "Normal": c.bump(dirt, 0.3, 0.05)}


def trim_sheet(c: Chain) -> Inputs:
    """A strip of a sheet, tinted for each object, with its packed masks."""
    at = c.placed("UV", (0.0, 0.25, 0.0), scale=(2.0, 0.5, 1.0))
    parts = c.add("SeparateColor", {0: c.image("packed", at)}).outputs
    info = c.add("ObjectInfo").outputs
    tinted = c.mix(parts["Blue"], c.image("color", at), info["Color"], "OVERLAY")
    hue = c.add("HueSaturation", {"Hue": c.math("MULTIPLY_ADD", info["Random"], 0.1, 0.45), "Color": tinted}).outputs[0]
    normal = c.add("NormalMap", {"Color": c.image("normal", at)}).outputs[0]
    return {"Base Color": hue, "Roughness": parts["Green"], "Normal": normal}


def triplanar(c: Chain) -> Inputs:
    """Images projected from three sides, so that no UV map is needed."""
    at = c.placed("Object", (0.5, 0.5, 0.5), scale=(0.4,) * 3)
    how = {"projection": "BOX", "projection_blend": 0.35}
    color, height = c.image("color", at, **how), c.image("occlusion", at, **how)
    grey = c.add("RGBToBW", {0: color}).outputs[0]
    bright = c.add("BrightContrast", {0: color, 1: 0.05, 2: 0.2}).outputs[0]
    return {"Base Color": bright, "Roughness": c.mask(grey, 0.1, 0.8), "Normal": c.bump(height, 0.4, 0.05)}


def edge_wear(c: Chain) -> Inputs:
    """Paint that is worn off at edges, whose place is broken up by noise."""
    edges = c.mask(c.add("NewGeometry").outputs["Pointiness"], 0.49, 0.56)
    noise = c.noise(c.coordinates("Object"), 6.0, 3.0)
    wear = c.math("MULTIPLY", edges, c.mask(noise, 0.35, 0.6), clamp=True)
    paint = c.mix(noise, (0.04, 0.12, 0.3, 1), (0.06, 0.18, 0.4, 1))
    color = c.mix(wear, paint, (0.55, 0.5, 0.45, 1))
    rough = c.add("MapRange", {"Value": wear, "To Min": 0.6, "To Max": 0.25}).outputs[0]
    return {"Base Color": color, "Roughness": rough, "Normal": c.bump(wear, 0.5, -0.02)}


def wood(c: Chain) -> Inputs:
    """Noise stretched along the grain that distorts rings."""
    at = c.placed("Object", turned=(0.1, 0.2, 0.3), scale=(1.0, 0.15, 1.0))
    given = {"Vector": c.add("VectorMath", {0: at, 1: c.noise(at, 2.0, 3.0, 0.5, "Color")}, operation="ADD").outputs[0]}
    rings = c.add("TexWave", given | {"Scale": 1.2, "Distortion": 1.5, "Detail": 2.0}, wave_type="RINGS").outputs["Fac"]
    color = c.ramp(rings, (0.0, (0.2, 0.09, 0.03)), (0.5, (0.4, 0.2, 0.08)), (1.0, (0.55, 0.32, 0.15)))
    fibre = c.noise(c.placed("Object", scale=(8.0, 0.6, 8.0)), 1.0, 2.0)
    mixed = c.mix(0.3, color, fibre, "SOFT_LIGHT")
    rough = c.add("MapRange", {"Value": rings, "To Min": 0.35, "To Max": 0.6}).outputs[0]
    return {"Base Color": mixed, "Roughness": rough, "Normal": c.bump(rings, 0.2, 0.03)}


def brick_wall(c: Chain) -> Inputs:
    """Bricks of two colours, with noise over them and mortar below."""
    given = {
        "Vector": c.coordinates("UV"),
        "Color1": (0.4, 0.1, 0.06, 1),
        "Color2": (0.25, 0.07, 0.04, 1),
        "Scale": 4.0,
    }
    brick = c.add("TexBrick", given | {"Mortar": (0.5, 0.48, 0.45, 1), "Mortar Smooth": 0.2, "Mortar Size": 0.03})
    noise = c.noise(c.coordinates("UV"), 14.0, 4.0)
    color = c.mix(0.6, brick.outputs["Color"], c.add("Gamma", {0: noise, 1: 0.8}).outputs[0], "OVERLAY")
    height = c.math("MULTIPLY_ADD", noise, 0.2, c.math("SUBTRACT", 1.0, brick.outputs["Fac"]))
    rough = c.mix(brick.outputs["Fac"], (0.6,) * 3 + (1,), (0.9,) * 3 + (1,))
    return {"Base Color": color, "Roughness": rough, "Normal": c.bump(height, 0.6, 0.05)}


def terrain(c: Chain) -> Inputs:
    """Grass, rock and snow by height and slope, with borders that noise moves."""
    geometry = c.add("NewGeometry").outputs
    noise = c.noise(geometry["Position"], 2.5, 5.0)
    height = c.math("MULTIPLY_ADD", noise, 0.5, c.part(geometry["Position"], "Z"))
    snow = c.add(
        "MapRange", {"Value": height, "From Min": 0.5, "From Max": 0.8}, interpolation_type="SMOOTHSTEP"
    ).outputs[0]
    steep = c.add("MapRange", {"Value": c.part(geometry["Normal"], "Z"), "From Min": 0.8, "From Max": 0.4}).outputs[0]
    ground = c.mix(steep, (0.08, 0.14, 0.03, 1), c.ramp(noise, (0.3, (0.12, 0.1, 0.08)), (0.7, (0.3, 0.27, 0.24))))
    color = c.mix(snow, ground, (0.85, 0.87, 0.9, 1))
    rough = c.math("MULTIPLY_ADD", snow, -0.4, 0.9)
    return {"Base Color": color, "Roughness": rough, "Normal": c.bump(noise, 0.5, 0.1)}


def skin(c: Chain) -> Inputs:
    """Mottled red and yellow, freckles, pores."""
    at = c.coordinates("Object")
    mottled = c.mix(c.noise(at, 1.5, 3.0), (0.6, 0.28, 0.2, 1), (0.7, 0.42, 0.28, 1))
    veins = c.mix(c.mask(c.noise(at, 4.0, 2.0, 1.0), 0.45, 0.7), mottled, (0.55, 0.16, 0.14, 1), "SOFT_LIGHT")
    freckles = c.ramp(c.voronoi(at, 6.0), (0.16, (1, 1, 1)), (0.28, (0, 0, 0)))
    color = c.mix(c.math("MULTIPLY", freckles, 0.5), veins, (0.3, 0.12, 0.07, 1))
    pores = c.voronoi(at, 18.0, feature="SMOOTH_F1")
    rough = c.add("MapRange", {"Value": pores, "To Min": 0.35, "To Max": 0.6}).outputs[0]
    return {"Base Color": color, "Roughness": rough, "Normal": c.bump(pores, 0.25, 0.02)}


def weave(c: Chain) -> Inputs:
    """Threads over and under each other, from two waves and a checker."""
    at = c.placed("UV", scale=(12.0, 12.0, 1.0))
    across, along = (
        c.math("ABSOLUTE", c.math("SINE", c.math("MULTIPLY", c.part(at, axis), 3.14159))) for axis in ("X", "Y")
    )
    over = c.add("TexChecker", {"Vector": at, "Scale": 1.0}).outputs["Fac"]
    height = c.add("Mix", {0: over, 2: across, 3: along}).outputs[0]
    threads = c.mix(over, (0.05, 0.08, 0.25, 1), (0.35, 0.1, 0.08, 1))
    color = c.mix(1.0, threads, c.ramp(height, (0.0, (0.3, 0.3, 0.3)), (1.0, (1, 1, 1))), "MULTIPLY")
    return {
        "Base Color": color,
        "Roughness": c.math("MULTIPLY_ADD", height, -0.2, 0.9),
        "Normal": c.bump(height, 0.4, 0.02),
    }


TREES = {
    "texture set": texture_set,
    "grunge": grunge,
    "trim sheet": trim_sheet,
    "triplanar": triplanar,
    "edge wear": edge_wear,
    "wood": wood,
    "brick wall": brick_wall,
    "terrain": terrain,
    "skin": skin,
    "weave": weave,
}
