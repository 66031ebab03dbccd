# SPDX-License-Identifier: GPL-3.0-or-later
"""The passes that a plan may name: one file each, with its pipeline's description and how it runs."""

from . import (
    accumulate,
    attributes,
    coarse_depth,
    holdouts,
    layers,
    lines,
    polygons,
    rest,
    rims,
    seen_range,
    shading,
    shadow_maps,
    visibility,
)

#: name in a `FramePlan` -> run(tile, planned) -> the target that was drawn into
RUN = {
    "background": shading.run,
    "shadow_maps": shadow_maps.run,
    "visibility": visibility.run,
    "rims": rims.run,
    "holdouts": holdouts.run,
    "seen_range": seen_range.run,
    "coarse_depth": coarse_depth.run,
    "attributes": attributes.run,
    "polygons": polygons.run,
    "start_layers": layers.start,
    "left": shading.run,
    "layer": shading.run,
    "peel": layers.peel,
    "rest": rest.run,
    "rest_shading": shading.run,
    "rest_layer": shading.run,
    "peel_rest": layers.peel,
    "lines": lines.run,
    "shading": shading.run,
    "sample_shading": shading.run,
    "resolve": shading.run,
    "accumulate": accumulate.run,
}
