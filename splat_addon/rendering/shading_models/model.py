# SPDX-License-Identifier: GPL-3.0-or-later
"""A registry entry for a shading model."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class ShadingModel:
    """An entry of the registry.

    name: also of shaders/shading_models/<name>.glsl and of its twin in `reference.shading_models`. label: for users.
    source: of the model, or "none needed". summary: what it shows.

    is_lit: it uses lights, with their shadows and light linking.
    shows_normals: it uses normals without lights.
    has_material: it uses roughness, metallic, reflectance and emission.
    has_finish: it uses what else a surface has (`scene.finish`).
    has_world: it uses the light of the world.
    world_light: the file in shaders/lib/world_light of the light from all around that it has instead; "" if none.
    tables: sampler -> the texture for a tile that its file reads beside the sums.
    values: name -> (type, value for a tile) that its file reads from the frame's block.
    sums: textures that are summed for it, and for an output of that name.
    features: (name, why) of features that exist only for it.
    """

    name: str
    label: str
    source: str
    summary: str
    is_lit: bool = False
    shows_normals: bool = False
    has_material: bool = False
    has_finish: bool = False
    has_world: bool = False
    world_light: str = ""
    tables: Mapping[str, Callable] = field(default_factory=dict)
    values: Mapping[str, tuple[str, Callable]] = field(default_factory=dict)
    sums: tuple[str, ...] = ()
    features: tuple[tuple[str, str], ...] = ()

    @property
    def is_diagnostic(self) -> bool:
        """Whether it shows how the picture is made."""
        return bool(self.sums or self.features)
