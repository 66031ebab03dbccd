# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan of a frame: its passes with their reasons, and the textures that they write."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, TypeVar

from .graph import Loop, Pass, Step, Texture, each_pass

if TYPE_CHECKING:
    from .planning import Planning

Found = TypeVar("Found")

#: Samples above and below that the silhouette filter reads.
FILTER_MARGIN = 2

#: Rows of visibility per row of samples if silhouettes are filtered; the first of them goes through the samples'
#: centres.
VISIBILITY_ROWS = 2


@dataclass(frozen=True)
class FramePlan:
    """tiles: (x, y, width, height) in pixels, each rendered with all passes and a margin for filters and lines.
    samples: N for N x N samples per pixel. multisamples: hardware samples for each of them, or 0.
    sample_shading: they are evaluated and lit one by one. method, storage, sum_format: as in the settings.
    filter_variance: of the Gaussian that filters a sample, in square samples.
    linear_depth: fragments write depth / far, because the hardware's depth would be too coarse.
    steps: passes and loops, in order. variants: those whose parts are in every program.
    choices: (name in paths of shaders, file). margin: pixels drawn around a tile and not kept.
    found: what was decided while planning.
    features: (name, why), of what is present beside passes. skipped: (what, why), of what others would need.
    limits: the reasons among these that tell users what the picture lacks.
    """

    tiles: tuple[tuple[int, int, int, int], ...]
    samples: int
    multisamples: int
    sample_shading: bool
    filter_variance: float
    method: str
    storage: str
    sum_format: str
    linear_depth: bool
    steps: tuple[Step, ...]
    variants: frozenset[str]
    choices: tuple[tuple[str, str], ...]
    margin: int
    found: Mapping[Callable[[Planning], object], object]
    features: tuple[tuple[str, str], ...]
    skipped: tuple[tuple[str, str], ...]
    limits: tuple[str, ...]

    def has(self, feature: str) -> bool:
        """Whether a feature is present."""
        return feature in (name for name, _ in self.features)

    def find(self, fact: Callable[[Planning], Found]) -> Found:
        """What was decided while planning, for passes that run. Raises RuntimeError for what nobody asked for then."""
        if fact not in self.found:
            raise RuntimeError(f"Nobody decided {fact.__name__} while this frame was planned; let its feature find it.")
        return self.found[fact]

    @cached_property
    def keys(self) -> dict[tuple[Texture, tuple[int, int], bool], tuple]:
        """What `tile.texture_key` has found."""
        return {}

    @cached_property
    def passes(self) -> tuple[Pass, ...]:
        """All passes in order; those of a loop once."""
        return tuple(each_pass(self.steps))

    @cached_property
    def count(self) -> int:
        """Number of passes, with those of a loop counted as often as they may run."""
        return sum(len(s.body) * s.times + len(s.last) if isinstance(s, Loop) else 1 for s in self.steps)

    @cached_property
    def drawn(self) -> tuple[int, int, int, int]:
        """x, y, width, height in pixels of all tiles together."""
        left, bottom = (min(tile[axis] for tile in self.tiles) for axis in (0, 1))
        right, top = (max(tile[axis] + tile[axis + 2] for tile in self.tiles) for axis in (0, 1))
        return left, bottom, right - left, top - bottom

    @cached_property
    def may_repeat(self) -> bool:
        """Whether the same calls may draw all samples from one place: no loop looks when it ends, and no textures are
        swapped. If a pass reads what it drew, they are not kept."""
        return not any(isinstance(step, Loop) or step.wiring.updates for step in self.steps)

    @cached_property
    def filled(self) -> dict[str, Texture]:
        """Every texture that some pass writes, by name; for updated textures also the second one."""
        found = {}
        for p in self.passes:
            found |= {texture.name: texture for texture in p.fills}
            found |= {f"{texture.name}_next": texture for texture in p.wiring.updates}
        return found

    @property
    def textures(self) -> tuple[str, ...]:
        """Names of all textures."""
        return tuple(self.filled)

    def size(self, texture: Texture, pixels: tuple[int, int]) -> tuple[int, int]:
        """Width and height of a texture, for a tile of this size in pixels including its margin."""
        return texture.per(self, pixels)

    def format(self, texture: Texture) -> str:
        """A name in `device.interface.FORMATS`."""
        return "RGBA16F" if texture.is_sum and self.sum_format == "float16" else texture.format

    def multisamples_of(self, texture: Texture) -> int:
        """Samples per texel, 0 for a single-sample texture."""
        return self.multisamples if texture.is_multisampled else 0

    def __str__(self) -> str:
        depth = "linear" if self.linear_depth else "hardware"
        lines = [
            f"{len(self.tiles)} tile(s), {self.samples} x {self.samples} samples, method {self.method}, {depth} depth, "
            f"{self.storage} splats, {self.sum_format} sums"
        ]
        if self.multisamples:
            each = "evaluated and lit one by one" if self.sample_shading else "evaluated once, lit once for their mean"
            lines.append(f"  with {self.multisamples} hardware samples in each: {each}")
        for step in self.steps:
            if isinstance(step, Loop):
                lines.append(f"  {step.name}, up to {step.times} times while any of {step.stop.name}; {step.reason}")
                lines += [_shown(p, "    ") for p in each_pass(step.body)]
                if step.last:
                    lines += ["  and if none was empty:", *(_shown(p, "    ") for p in each_pass(step.last))]
            else:
                lines += [_shown(p, "  ") for p in each_pass((step,))]
        lines += [f"  with {name}: {why}" for name, why in self.features]
        lines += [f"  without {what}: {why}" for what, why in self.skipped]
        return "\n".join(lines)


def _shown(p: Pass, indent: str) -> str:
    parts = " + ".join(dict.fromkeys(part.feature for part in p.parts))
    once = ", once" if p.once is not None else ""
    reads = ", ".join(p.reads) or "what is placed"
    return f"{indent}{p.name}{once} [{parts}]: {', '.join(p.writes)} <- {reads}; {p.reason}"
