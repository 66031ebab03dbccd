# SPDX-License-Identifier: GPL-3.0-or-later
"""How many samples a pixel has, in final renders and in the viewport."""

from __future__ import annotations

from collections.abc import Iterator

import bpy
from bpy.props import IntProperty

from ...rendering.settings import MAX_SAMPLES, MAX_SUPERSAMPLING, Settings
from ..ids import RENDER_SETTINGS

#: A new scene's samples, of F12 as of the viewport at rest: creases and the edges of polygons are smooth in both.
_SAMPLES = 16


class SampleProperties:
    """A mix-in for the scene's render settings."""

    supersampling: IntProperty(
        name="Supersampling",
        description=(
            "Samples along each side of a pixel in final renders, so 3 means 9 samples. Use 1 with Mip Filter; "
            "with Quads, more samples are sharper and slower"
        ),
        min=1,
        max=MAX_SUPERSAMPLING,
        soft_max=8,
        default=Settings.supersampling,
    )
    viewport_supersampling: IntProperty(
        name="Viewport Supersampling",
        description="Samples along each side of a pixel in the viewport",
        min=1,
        max=MAX_SUPERSAMPLING,
        soft_max=4,
        default=1,
    )
    samples: IntProperty(
        name="Samples",
        description=(
            "Number of pictures that a final render averages, each with another offset in the pixel, on the lens "
            "and in time. The time grows with the number"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=_SAMPLES,
    )
    blur_samples: IntProperty(
        name="Blur Samples",
        description=(
            "Minimum number of samples of a final render with depth of field or motion blur, because a single sample "
            "shows no blur. Set it to 1 so that only Samples counts"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=_SAMPLES,
    )
    viewport_samples: IntProperty(
        name="Viewport Samples",
        description=("Number of pictures that the viewport averages while nothing changes"),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=_SAMPLES,
    )
    motion_blur_steps: IntProperty(
        name="Shutter Steps",
        description=(
            "Number of times during the open shutter at which the scene is evaluated. Fewer are faster, but show "
            "moving objects as separate pictures"
        ),
        min=1,
        max=MAX_SAMPLES,
        soft_max=256,
        default=64,
    )


def final_samples(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> int:
    """The number of samples of a final render of a view layer."""
    properties = getattr(scene, RENDER_SETTINGS)
    samples = min(view_layer.samples, MAX_SAMPLES) or properties.samples
    return max(samples, properties.blur_samples) if any(blurs(scene, view_layer)) else samples


def is_coarser_than_viewport(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> bool:
    """Whether a final render of a view layer has fewer samples per pixel than the viewport at rest."""
    properties = getattr(scene, RENDER_SETTINGS)
    final = final_samples(scene, view_layer) * properties.supersampling**2
    return final < properties.viewport_samples * properties.viewport_supersampling**2


def blurs(scene: bpy.types.Scene, view_layer: bpy.types.ViewLayer) -> Iterator[str]:
    """Enabled effects that a final render with one sample would not show."""
    camera = scene.camera
    if camera is not None and camera.type == "CAMERA" and camera.data.type == "PERSP" and camera.data.dof.use_dof:
        yield "Depth of Field"
    if scene.render.use_motion_blur and view_layer.use_motion_blur:
        yield "Motion Blur"
