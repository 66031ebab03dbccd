# SPDX-License-Identifier: GPL-3.0-or-later
"""Storage formats of surfels on the device: one registry entry and one GLSL file, shaders/storage/<name>.glsl, each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from ...surfels import Surfels
from .packing import pack_surfels
from .packing_16_bit import pack_16_bit


@dataclass(frozen=True)
class Storage:
    """A storage format.

    name: also of its GLSL file. label, summary: for users. textures: (sampler, format) of each texture. pack: function
    from surfels and their `stored_order` to their (h, w, 4) float32 texels, and the number of surfels whose position
    becomes visibly less precise.
    """

    name: str
    label: str
    summary: str
    textures: tuple[tuple[str, str], ...]
    pack: Callable[[Surfels, np.ndarray], tuple[tuple[np.ndarray, ...], int]]

    @property
    def samplers(self) -> tuple[str, ...]:
        """Names of the textures' samplers."""
        return tuple(sampler for sampler, _ in self.textures)


STORAGES = {
    storage.name: storage
    for storage in (
        Storage(
            "float32",
            "Float 32",
            "Exact, with twice the memory of 16 Bit",
            (("surfels", "RGBA32F"),),
            lambda surfels, order: ((pack_surfels(surfels, order),), 0),
        ),
        Storage(
            "16-bit",
            "16 Bit",
            ("Takes half the memory; differences from Float 32 are invisible"),
            (("surfels", "RGBA16"), ("surfel_blocks", "RGBA32F")),
            pack_16_bit,
        ),
    )
}


def get_storage(name: str) -> Storage:
    """Raises ValueError for a name that is not registered."""
    if name not in STORAGES:
        raise ValueError(f"A storage is one of {', '.join(STORAGES)}, not {name!r}.")
    return STORAGES[name]
