# SPDX-License-Identifier: GPL-3.0-or-later
"""A graph of shading nodes as plain values, and its evaluation over arrays of samples."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from . import colors, curves, images, mixing, numbers, procedural, skies, spectra, vectors

#: Samples evaluated together: few enough for temporaries to stay in the processor's cache.
BLOCK = 1 << 13

#: kind of step -> function of its inputs' arrays, then its settings
FUNCTIONS = {
    **colors.FUNCTIONS,
    **curves.FUNCTIONS,
    **mixing.FUNCTIONS,
    **numbers.FUNCTIONS,
    **procedural.FUNCTIONS,
    **skies.FUNCTIONS,
    **spectra.FUNCTIONS,
    **vectors.FUNCTIONS,
}

#: Kinds of steps that read the inputs of the samples, one layer each, and how many numbers of a layer they take.
UV, ATTRIBUTE, ATTRIBUTE_ALPHA = "uv", "attribute", "attribute alpha"
LAYERS = {UV: ("uvs", 2, slice(0, 2)), ATTRIBUTE: ("colors", 4, slice(0, 3)), ATTRIBUTE_ALPHA: ("colors", 4, 3)}

#: Places beside a sample: the direction in the grid, and the share of the way to the next. The nearer ones are for
#: slopes.
_BESIDE = {1: (0, 1.0), 2: (1, 1.0), 3: (0, 0.25), 4: (1, 0.25)}

#: The kind of step that bends a normal: of a height, a place, the normal, a strength and a distance.
BUMP = "bump"


@dataclass(frozen=True, eq=False)
class Step:
    """One function of a graph.

    kind: a name in `FUNCTIONS`, in `images.LOOKUPS`, or one that reads a layer of the samples.
    inputs: an integer is the number of an earlier step, a tuple a constant of 1 or 3 numbers.
    settings: what is no socket: numbers, names, tables, images.
    """

    kind: str
    inputs: tuple[int | tuple[float, ...], ...] = ()
    settings: tuple = ()


@dataclass(frozen=True, eq=False)
class Graph:
    """Steps in an order in which each reads earlier ones; the last is the result. Raises ValueError with a sentence."""

    steps: tuple[Step, ...]

    def __post_init__(self):
        for number, step in enumerate(self.steps):
            if not any(step.kind in kinds for kinds in (FUNCTIONS, LAYERS, images.LOOKUPS, (BUMP,))):
                raise ValueError(f"A shading graph has no step of the kind {step.kind!r}.")
            if any(isinstance(given, int) and not 0 <= given < number for given in step.inputs):
                raise ValueError(f"Step {number} of a shading graph reads a step that does not come before it.")

    @cached_property
    def kinds(self) -> frozenset[str]:
        return frozenset(step.kind for step in self.steps)

    @cached_property
    def key(self) -> tuple:
        """Equal for graphs that do the same with the same images."""
        return tuple((step.kind, step.inputs, *map(_hashable, step.settings)) for step in self.steps)

    @property
    def reads_uvs(self) -> bool:
        return UV in self.kinds

    @property
    def reads_colors(self) -> bool:
        return not self.kinds.isdisjoint((ATTRIBUTE, ATTRIBUTE_ALPHA))

    @property
    def looks_up(self) -> bool:
        """Whether it looks up images."""
        return not self.kinds.isdisjoint(images.LOOKUPS)

    @property
    def looks_beside(self) -> bool:
        """Whether it reads what lies beside the samples."""
        return self.looks_up or self.is_procedural or BUMP in self.kinds

    @property
    def is_procedural(self) -> bool:
        """Whether it may change between neighbouring samples by more than they show."""
        return not self.kinds.isdisjoint(procedural.FUNCTIONS)

    @property
    def is_constant(self) -> bool:
        return not (self.reads_uvs or self.reads_colors or self.looks_up)


@dataclass(frozen=True, eq=False)
class Inputs:
    """What a graph can read of n samples.

    uvs: (2 layers, n) texture coordinates. colors: (4 layers, n) attributes, places and directions. Either may be None,
    and a layer that is not there is 0.
    uv_steps, color_steps: (2, rows, n) their change to the next sample in the two directions of the grid, by which
    images are filtered; None: not known, so that images are looked up as they are.
    """

    count: int
    uvs: np.ndarray | None = None
    colors: np.ndarray | None = None
    uv_steps: np.ndarray | None = None
    color_steps: np.ndarray | None = None

    def moved(self, columns: float, rows: float) -> Inputs:
        """The inputs at places that lie this share of the way to the next sample in the two directions."""
        arrays = []
        for values, steps in ((self.uvs, self.uv_steps), (self.colors, self.color_steps)):
            known = values is not None and steps is not None
            arrays.append(values + columns * steps[0] + rows * steps[1] if known else values)
        return Inputs(self.count, *arrays, self.uv_steps, self.color_steps)

    def take(self, part: slice) -> Inputs:
        count = len(range(*part.indices(self.count)))
        arrays = (self.uvs, self.colors, self.uv_steps, self.color_steps)
        return Inputs(count, *(None if array is None else array[..., part] for array in arrays))

    def layer(self, name: str, width: int, index: int, beside: int) -> np.ndarray:
        """(width, n) of a layer; beside: 0, or a key of `_BESIDE`."""
        rows = getattr(self, name)
        if rows is None or len(rows) < (index + 1) * width:
            return np.zeros((width, 1), np.float32)
        part = slice(index * width, (index + 1) * width)
        steps = getattr(self, f"{name[:-1]}_steps")
        if not beside or steps is None:
            return rows[part]
        direction, share = _BESIDE[beside]
        return rows[part] + steps[direction, part] * np.float32(share)


def pruned(steps: Sequence[Step], result: int) -> tuple[Graph, list[int]]:
    """The graph of the steps that one of them needs, and the numbers that these had."""
    needed, waiting = set(), [result]
    while waiting:
        number = waiting.pop()
        if number not in needed:
            needed.add(number)
            waiting += [given for given in steps[number].inputs if isinstance(given, int)]
    order = sorted(needed)
    place = {number: k for k, number in enumerate(order)}
    kept = [steps[number] for number in order]
    kept = [replace(s, inputs=tuple(place[g] if isinstance(g, int) else g for g in s.inputs)) for s in kept]
    return Graph(tuple(kept)), order


def _hashable(setting):
    return (setting.shape, setting.tobytes()) if isinstance(setting, np.ndarray) else setting


def evaluate(graph: Graph, inputs: Inputs) -> np.ndarray:
    """(1 or 3, n) float32 values of the graph's last step; what is no finite number is 0, as in shaders.

    A graph with procedural textures is the mean of four places in the cell of each sample, if its steps are known.
    """
    result = None
    for start in range(0, max(inputs.count, 1), BLOCK):
        part = slice(start, start + BLOCK)
        with np.errstate(all="ignore"):
            values = _block(graph, inputs.take(part))
        if result is None:
            result = np.empty((3 if values.ndim == 2 else 1, inputs.count), np.float32)
        result[:, part] = values
    return result if np.isfinite(result).all() else np.nan_to_num(result, copy=False, nan=0.0, posinf=0.0, neginf=0.0)


#: Where a procedural texture is looked up in the cell around a sample, as shares of the way to the next.
_PLACES = ((-0.25, -0.25), (0.25, -0.25), (-0.25, 0.25), (0.25, 0.25))


def _block(graph: Graph, inputs: Inputs) -> np.ndarray:
    result = len(graph.steps) - 1
    is_wide = inputs.uv_steps is not None or inputs.color_steps is not None
    if not (graph.is_procedural and is_wide):
        return _Run(graph, inputs).value(result, 0)
    return sum(_Run(graph, inputs.moved(*place)).value(result, 0) for place in _PLACES) / np.float32(len(_PLACES))


def constant_value(graph: Graph) -> tuple[float, ...]:
    """The 1 or 3 numbers of a graph that reads nothing of the samples."""
    return tuple(evaluate(graph, Inputs(1))[:, 0].tolist())


class _Run:
    """One evaluation of a graph. Values have shape (n,) or (1,), colours and vectors (3, n) or (3, 1)."""

    def __init__(self, graph: Graph, inputs: Inputs):
        self._steps, self._inputs = graph.steps, inputs
        self._values: dict[tuple[int, int], np.ndarray] = {}

    def value(self, number: int, beside: int) -> np.ndarray:
        """What a step comes to. beside: as in `Inputs.layer`."""
        key = number, beside
        if key not in self._values:
            self._values[key] = self._computed(self._steps[number], beside)
        return self._values[key]

    def _computed(self, step: Step, beside: int) -> np.ndarray:
        if step.kind in LAYERS:
            return self._layer(step, beside)
        if step.kind == BUMP:
            heights, places = ([self._given(given, k) for k in (0, 3, 4)] for given in step.inputs[:2])
            return vectors.bumped(heights, places, *(self._given(given, beside) for given in step.inputs[2:]))
        if step.kind in images.LOOKUPS:
            at = step.inputs[0]
            places = [self._given(at, beside), *(self._given(at, k) for k in range(3))]
            others = [self._given(given, beside) for given in step.inputs[1:]]
            return images.LOOKUPS[step.kind](places, *others, *step.settings)
        return FUNCTIONS[step.kind](*(self._given(given, beside) for given in step.inputs), *step.settings)

    def _given(self, given: int | tuple[float, ...], beside: int) -> np.ndarray:
        if isinstance(given, int):
            return self.value(given, beside)
        return np.array(given, np.float32) if len(given) == 1 else np.array(given, np.float32)[:, None]

    def _layer(self, step: Step, beside: int) -> np.ndarray:
        name, width, part = LAYERS[step.kind]
        rows = self._inputs.layer(name, width, step.settings[0], beside)[part]
        if step.kind == UV:
            rows = np.concatenate([rows, np.zeros_like(rows[:1])])
        return np.asarray(rows, np.float32)
