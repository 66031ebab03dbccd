# SPDX-License-Identifier: GPL-3.0-or-later
"""What the Sky Texture node becomes."""

from __future__ import annotations

import math

import numpy as np

from ....shading_nodes.skies import Air, Daylight, Disc, Sky
from ... import working_space
from ..mesh_layers import GENERATED
from ..node_trees import called
from ..node_walks import Node
from .reading import GraphReading, Value, reads
from .sources import coordinates, derived

#: How bright Preetham's sky is beside that of Hosek and Wilkie, on average, in Blender's units.
_BRIGHTER = 6.0

#: Shares of a disc over which its rim fades out where no picture has pixels.
_RIM = 0.1


@reads("TexSky")
def _sky(tree: GraphReading, node: Node, output: str) -> Value:
    toward = _direction(tree, node)
    from_xyz = np.linalg.inv(working_space.to_xyz())
    if node.sky_type not in ("PREETHAM", "HOSEK_WILKIE"):
        return tree.color("scattered sky", toward, settings=(_scattered(tree, node), from_xyz))
    if node.sky_type == "HOSEK_WILKIE":
        what = f"{called(node)} of the kind Hosek / Wilkie, whose tables are not part of this extension"
        tree.doubts[what] = "Preetham's sky is used, at a sixth of its brightness"
        from_xyz = from_xyz / _BRIGHTER
    sun = np.array(node.sun_direction, np.float64)
    length = np.linalg.norm(sun)
    sun = sun / length if length > 0 else np.array([0.0, 0.0, 1.0])
    return tree.color("daylight sky", toward, settings=(Daylight(tuple(sun.tolist()), node.turbidity), from_xyz))


def _direction(tree: GraphReading, node: Node) -> Value:
    """What feeds it; with its sun's disc it has no such input."""
    vector = next((socket for socket in node.inputs if socket.enabled), None)
    return derived(tree, GENERATED) if vector is None else coordinates(tree, vector, lambda t: derived(t, GENERATED))


def _scattered(tree: GraphReading, node: Node) -> Sky:
    # a sun beyond the zenith is on the other side
    elevation = math.asin(math.sin(node.sun_elevation))
    turn = node.sun_rotation + (math.pi if math.cos(node.sun_elevation) < 0 else 0.0)
    aerosols = node.aerosol_density if hasattr(node, "aerosol_density") else node.dust_density
    is_multiple = node.sky_type == "MULTIPLE_SCATTERING"
    air = Air(is_multiple, elevation, node.altitude, node.air_density, aerosols, node.ozone_density)
    if not (node.sun_disc and node.sun_size > 0 and node.sun_intensity > 0):
        return Sky(air, turn, None)
    sky, show = Sky(air, turn, None), getattr(tree.layers, "show_sun", None)
    edge = show(sky.toward, node.sun_size) if show else _RIM * node.sun_size
    return sky._replace(disc=Disc(node.sun_size, node.sun_intensity, edge))
