# SPDX-License-Identifier: GPL-3.0-or-later
"""What the registry says of a shading model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class ShadingModel:
    """name: also of shaders/shading_models/<name>.glsl and of its twin in `reference.shading_models`. label: for users.
    source: of the model. summary: what it shows. cost: time of a frame, as a multiple of flat's
        (docs/evidence/features.md).

    is_lit: it looks at lights, with their shadows and the objects they are linked to.
    has_material: it looks at roughness, metallic, reflectance and emission.
    has_world: it looks at the light of the world around.
    tables: sampler -> the texture for a tile, of what its file reads beside the sums.
    values: name -> (type, value for a tile) of what its file is told in the frame's block.
    sums: added up for it, and for an output of that name.
    features: (name, why) of what is defined for it alone.
    """

    name: str
    label: str
    source: str
    summary: str
    cost: float
    is_lit: bool = False
    has_material: bool = False
    has_world: bool = False
    tables: Mapping[str, Callable] = field(default_factory=dict)
    values: Mapping[str, tuple[str, Callable]] = field(default_factory=dict)
    sums: tuple[str, ...] = ()
    features: tuple[tuple[str, str], ...] = ()

    @property
    def is_diagnostic(self) -> bool:
        """Whether it shows how the picture is made."""
        return bool(self.sums or self.features)
