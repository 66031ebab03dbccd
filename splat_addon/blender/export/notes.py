# SPDX-License-Identifier: GPL-3.0-or-later
"""What is told about a scene that was read."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

from ...faults import sentence_of


@dataclass
class Notes:
    """Messages about a scene: sentence -> how often. left_out: messages about objects or lights that should be visible
    but are not."""

    counts: Counter = field(default_factory=Counter)
    left_out: list[str] = field(default_factory=list)

    def add(self, sentence: str, count: int = 1) -> None:
        if count:
            self.counts[sentence] += count

    def leave_out(self, name: str, error: Exception) -> None:
        """Record that an object or light of this name cannot be drawn. Without memory, nothing can: raises MemoryError
        again."""
        if isinstance(error, MemoryError):
            raise error
        self.left_out.append(f"{name} is left out: {sentence_of(error)}")
        self.add(self.left_out[-1])

    def add_those_of(self, other: Notes, times: int) -> None:
        """Add what was said of one thing for that many like it."""
        self.left_out += other.left_out * times
        for sentence, count in other.counts.items():
            self.add(sentence, count * times)

    def sentences(self) -> list[str]:
        """One sentence each, with its count if it occurred more than once."""
        return [text if count == 1 else f"{text} ({count} times)" for text, count in self.counts.items()]
