# SPDX-License-Identifier: GPL-3.0-or-later
"""Phong Splatting stores how normals change over surfels, as point attributes, and only where it is asked for."""

import bpy
import numpy as np

from splat_addon.blender.ids import POINT_ATTRIBUTES
from splat_addon.normal_fields import NORMAL_FIELDS, NORMAL_STEP


def test_a_smooth_ball_has_changing_normals_if_they_are_asked_for(convert, surfels_of):
    bpy.ops.mesh.primitive_uv_sphere_add(segments=48, ring_count=24, radius=2)
    ball = bpy.context.object
    bpy.ops.object.shade_smooth()
    names = {POINT_ATTRIBUTES[name].name for name in NORMAL_FIELDS}
    (plain,) = convert(resolution=12)
    assert not names & set(plain.data.attributes.keys())
    bpy.context.view_layer.objects.active = ball
    plain.select_set(False)
    ball.select_set(True)
    (made,) = convert(resolution=12, normal_fields=True)
    assert names <= set(made.data.attributes.keys())
    surfels = surfels_of(made)
    change = surfels.normal_along_x[:, 0] * NORMAL_STEP
    assert abs(np.median(change / (surfels.scales[:, 0] / 2)) - 1) < 0.05
