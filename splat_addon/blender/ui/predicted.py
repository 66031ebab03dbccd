# SPDX-License-Identifier: GPL-3.0-or-later
"""What the sidebar says about the result of a conversion before it is made."""

from __future__ import annotations

import bpy

from ...faults import sentence_of
from ...sampling import UNKNOWN_FLAT_EXTENTS
from ..conversion.automatic_density import automatic_spacing
from ..conversion.camera_density import without_camera
from ..conversion.choices import Choices
from ..conversion.density_reason import Reason, sentences
from ..conversion.gathering import frame_of, groups
from ..conversion.prediction import Extent, known_extents
from ..density import Density, Measure
from ..object_detail import detail_of
from ..spoken import said


def prediction(context: bpy.types.Context, sources: list[bpy.types.Object], asked: Choices) -> str:
    """Lines about what the sources will become and why at that density, or why they cannot be converted."""
    parts = groups(sources, context.active_object, asked.join)
    extents = known_extents(parts, asked)
    if extents is None:
        return said("Counting …")
    try:
        found = [_density_of(*pair, asked, context.view_layer.depsgraph) for pair in zip(parts, extents, strict=True)]
    except Exception as error:
        return sentence_of(error)
    text = prediction_text([extent.predict(f) for extent, (f, _) in zip(extents, found, strict=True)])
    if asked.tolerance or any(extent.flat is UNKNOWN_FLAT_EXTENTS for extent in extents):
        text = said("{count}, fewer where flat", count=text)
    return "\n".join([text, *sentences(reason for _, reason in found if reason)])


def _density_of(sources, extent: Extent, asked: Choices, depsgraph) -> tuple[Density, Reason | None]:
    """The density in the form that `Extent.predict` takes, and the reason if it is automatic. Raises ValueError."""
    detail, frame = detail_of(sources[0]), frame_of(sources[0], asked.in_world_units)
    if asked.density.measure != Measure.AUTOMATIC:
        return without_camera(asked.density.finer(detail), lambda: extent.surface, frame, depsgraph), None
    spacing, reason = automatic_spacing(
        asked.density.value,
        lambda: extent.surface,
        extent.area,
        extent.longest_edge,
        frame,
        depsgraph,
        sources,
        detail,
        extent.flat.saved,
    )
    return Density(Measure.SPACING, spacing), reason


def prediction_text(predictions: list[tuple[int, float]]) -> str:
    """A text with the total number of surfels and their spacing."""
    counts, spacings = zip(*predictions, strict=True)
    if not sum(counts):
        return said("Nothing to sample: no faces, or a density of 0")
    low, high = (f"{bound(spacings):.3g}" for bound in (min, max))
    if low == high:
        return said("≈ {count:,} surfels, spacing {spacing}", count=sum(counts), spacing=low)
    return said("≈ {count:,} surfels, spacing {low} to {high}", count=sum(counts), low=low, high=high)
