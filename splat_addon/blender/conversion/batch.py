# SPDX-License-Identifier: GPL-3.0-or-later
"""Converts several sources in turn, driven by a converting operator from `execute` or from its modal timer.

Nothing is added to the file until every source is sampled, so a cancelled batch leaves no trace, and an unusable source
does not stop the others.
"""

from __future__ import annotations

import time
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator

import bpy
import numpy as np

from ...doubts import doubts
from ...faults import sentence_of
from ...sampling import Sampling, SamplingCancelled, sample_surface
from ..spoken import said
from .as_rendered import as_rendered
from .choices import Choices
from .following import at_origin_of_source, with_short_origin
from .gathering import groups
from .mesh_conversion import Conversion, bake, place, prepare, sample
from .painted_as import forget, remember
from .source_record import record_of
from .surfel_objects import active_collection, refill, select_only


class Batch(ABC):
    """Groups of objects, each of which becomes one surfel object: read, sample, place. Subclasses implement these
    steps.

    refused: (object name, sentence) of each group that could not be converted. share: finished share, 0 to 1.
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

    def status(self) -> str:
        """What the status bar shows."""
        return said("Converting to surfels: {percent:.0f}%   Esc cancels", percent=100 * self.share)

    @property
    def has_sources(self) -> bool:
        return bool(self._groups)

    @property
    def has_surfels(self) -> bool:
        return bool(self._sampled)

    def prepared(self, context: bpy.types.Context) -> Iterator:
        """Yield the usable sources, each read from Blender on demand; pass each to `sample` before taking the next."""
        for sources in self._groups:
            self._begun, self._part = self._begun + 1, 0.0
            try:
                with as_rendered(sources, context) as depsgraph:
                    conversion = self._prepare(sources, depsgraph)
                yield conversion
            except Exception as error:
                self.refused.append((sources[0].name, sentence_of(error)))

    def sample(self, conversion, report=lambda share: None) -> None:
        """Sample one source; may run in another thread. report: called regularly with `share`."""

        def progress(part: float) -> bool:
            self._part = part
            report(self.share)
            return not self.is_cancelled

        try:
            self._sample(conversion, progress)
        except SamplingCancelled:
            return
        except Exception as error:
            self.refused.append((conversion.name, sentence_of(error)))
        else:
            self._sampled.append(conversion)

    def place_all(self, context: bpy.types.Context) -> list[tuple[object, bpy.types.Object]]:
        """Add the surfel objects to the file, select them and make the last one active."""
        made = [(conversion, self._placed(conversion, context)) for conversion in self._sampled]
        select_only(context, [new for _, new in made])
        return made

    def _placed(self, conversion, context: bpy.types.Context) -> bpy.types.Object:
        start = time.perf_counter()
        self._finish(conversion, context)
        made = self._place(conversion, context)
        record_of(made).origin = conversion.surfels.origin
        self._remember(made, conversion)
        conversion.seconds += time.perf_counter() - start
        return made

    def replace(self, made: bpy.types.Object, context: bpy.types.Context) -> list:
        """Give a surfel object new surfels, from a single source or from several that were joined."""
        for conversion in self._sampled:
            start, record = time.perf_counter(), record_of(made)
            self._finish(conversion, context)
            refill(made, conversion.surfels, np.array(record.origin, np.float64), conversion.materials)
            record.origin = conversion.surfels.origin
            self._remember(made, conversion)
            conversion.seconds += time.perf_counter() - start
        return self._sampled

    def _finish(self, conversion, context: bpy.types.Context) -> None:
        """Finish the surfels; may access Blender."""
        conversion.surfels = with_short_origin(at_origin_of_source(conversion.surfels))

    def _remember(self, made: bpy.types.Object, conversion) -> None:
        """Keep in new surfels of what their colours were made."""
        forget(made.data)

    @abstractmethod
    def _prepare(self, sources: list[bpy.types.Object], depsgraph: bpy.types.Depsgraph):
        """What `_sample` needs, with a `name`. Raises ValueError with a sentence."""

    @abstractmethod
    def _sample(self, conversion, progress) -> None:
        """Sample without accessing Blender. Raises the exceptions of sampling."""

    @abstractmethod
    def _place(self, conversion, context: bpy.types.Context) -> bpy.types.Object:
        """Add the new surfel object to the file."""


class ConversionBatch(Batch):
    """A batch of surfaces. active: the object whose place a joined result takes. sampler: replaces `sample_surface`."""

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
            except Exception as error:
                conversion.notes.append(f"Nothing was baked: {sentence_of(error)}")
        conversion.notes += doubts(conversion.surfels)
        super()._finish(conversion, context)

    def _remember(self, made, conversion: Conversion) -> None:
        remember(made, conversion)

    def _place(self, conversion: Conversion, context) -> bpy.types.Object:
        return place(conversion, active_collection(context))
