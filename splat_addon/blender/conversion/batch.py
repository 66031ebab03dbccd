# SPDX-License-Identifier: GPL-3.0-or-later
"""Several sources, one after another: what a converting operator drives, from `execute` or from its modal timer.

Nothing is added to the file until every source is sampled, so that a cancelled batch leaves no trace, and a source
with nothing usable does not stop the others.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator

import bpy
from mathutils import Matrix, Vector

from ...sampling import Sampling, SamplingCancelled, sample_surface
from .as_rendered import as_rendered
from .following import at_origin_of_source
from .gathering import groups
from .mesh_conversion import Choices, Conversion, bake, place, prepare, sample
from .source_record import record_of
from .surfel_objects import refill, select_only


class Batch(ABC):
    """Groups of objects on their way, each to one surfel object: read, sample, place, which subclasses do.

    refused: (object name, sentence) of each group that could not be converted. share: finished part, 0 to 1.
    """

    def __init__(self, groups: list[list[bpy.types.Object]]):
        self._groups = groups
        self._sampled: list = []
        self._begun = 0
        self._part = 0.0
        self.refused: list[tuple[str, str]] = []
        self.is_cancelled = False

    @property
    def share(self) -> float:
        return (max(self._begun - 1, 0) + self._part) / len(self._groups)

    @property
    def has_sources(self) -> bool:
        return bool(self._groups)

    @property
    def has_surfels(self) -> bool:
        return bool(self._sampled)

    def prepared(self, context: bpy.types.Context) -> Iterator:
        """The usable ones, each read from Blender when it is asked for; give it to `sample` before the next."""
        for sources in self._groups:
            self._begun, self._part = self._begun + 1, 0.0
            try:
                with as_rendered(sources, context) as depsgraph:
                    conversion = self._prepare(sources, depsgraph)
                yield conversion
            except ValueError as error:
                self.refused.append((sources[0].name, str(error)))

    def sample(self, conversion, report=lambda share: None) -> None:
        """Sample one source; may run in another thread. report: called with `share` now and then."""

        def progress(part: float) -> bool:
            self._part = part
            report(self.share)
            return not self.is_cancelled

        try:
            self._sample(conversion, progress)
        except SamplingCancelled:
            return
        except (ValueError, MemoryError) as error:
            sentence = str(error) or "The memory does not suffice; make fewer surfels."
            self.refused.append((conversion.name, sentence))
        else:
            self._sampled.append(conversion)

    def place_all(self, context: bpy.types.Context) -> list[tuple[object, bpy.types.Object]]:
        """Add the surfel objects to the file; they are selected, and the last is active."""
        made = [(conversion, self._placed(conversion, context)) for conversion in self._sampled]
        select_only(context, [new for _, new in made])
        return made

    def _placed(self, conversion, context: bpy.types.Context) -> bpy.types.Object:
        start = time.perf_counter()
        self._finish(conversion, context)
        made = self._place(conversion, context)
        record_of(made).origin = conversion.surfels.origin
        conversion.seconds += time.perf_counter() - start
        return made

    def replace(self, made: bpy.types.Object, context: bpy.types.Context) -> list:
        """Give a surfel object the surfels of the one source that was sampled, or of several that were joined."""
        for conversion in self._sampled:
            start, record = time.perf_counter(), record_of(made)
            self._finish(conversion, context)
            refill(made, conversion.surfels, conversion.materials)
            shift = Vector(conversion.surfels.origin) - Vector(record.origin)
            made.matrix_basis = made.matrix_basis @ Matrix.Translation(shift)
            record.origin = conversion.surfels.origin
            conversion.seconds += time.perf_counter() - start
        return self._sampled

    def _finish(self, conversion, context: bpy.types.Context) -> None:
        """What is left to do with the surfels and may ask Blender."""
        conversion.surfels = at_origin_of_source(conversion.surfels)

    @abstractmethod
    def _prepare(self, sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph):
        """What `_sample` needs, with a `name`. Raises ValueError with a sentence."""

    @abstractmethod
    def _sample(self, conversion, progress) -> None:
        """Touches nothing of Blender's. Raises what sampling does."""

    @abstractmethod
    def _place(self, conversion, context: bpy.types.Context) -> bpy.types.Object:
        """The new surfel object, in the file."""


class ConversionBatch(Batch):
    """Of surfaces. active: whose place a joined result takes. sampler: gives what `sample_surface` does."""

    def __init__(
        self,
        sources: list[bpy.types.Object],
        choices: Choices,
        active: bpy.types.Object | None = None,
        sampler: Callable[..., Sampling] = sample_surface,
    ):
        super().__init__(groups(sources, active, choices.join))
        self._choices, self._sampler = choices, sampler

    def _prepare(self, sources, depsgraph) -> Conversion:
        return prepare(sources, depsgraph, self._choices)

    def _sample(self, conversion: Conversion, progress) -> None:
        sample(conversion, progress, self._sampler)

    def _finish(self, conversion: Conversion, context) -> None:
        if conversion.unread:
            try:
                with as_rendered(conversion.sources, context) as depsgraph:
                    bake(conversion, depsgraph)
            except ValueError as error:
                conversion.notes.append(f"Nothing was baked: {error}")
        super()._finish(conversion, context)

    def _place(self, conversion: Conversion, context) -> bpy.types.Object:
        return place(conversion, context.collection)
