# SPDX-License-Identifier: GPL-3.0-or-later
"""The difference between two plans: passes, shader parts, textures and their size in bytes."""

from __future__ import annotations

import math

from splat_addon.rendering import FramePlan
from splat_addon.rendering.features import INPUTS

#: format -> bytes per texel
BYTES = {"RGBA32F": 16, "RGBA16F": 8, "RGBA16": 8, "RG32F": 8, "R32F": 4, "DEPTH32F": 4}


def planned_bytes(plan: FramePlan) -> int:
    """Bytes of the textures that passes write, for the first tile including its margin."""
    _, _, width, height = plan.tiles[0]
    pixels = width + 2 * plan.margin, height + 2 * plan.margin
    return sum(
        math.prod(plan.size(t, pixels)) * max(plan.multisamples_of(t), 1) * BYTES[plan.format(t)]
        for t in plan.filled.values()
    )


def added(without: FramePlan, present: FramePlan) -> tuple[str, str]:
    """Added passes, shader parts, textures and tables; removed ones have a minus sign."""
    return _difference(_done(without), _done(present)), _difference(_read(without), _read(present))


def _done(plan: FramePlan) -> list[str]:
    features = [name.lower().replace("_", " ") for name, _ in plan.features]
    return [*(p.name for p in plan.passes), *features, *(["linear depth"] if plan.linear_depth else [])]


def _read(plan: FramePlan) -> list[str]:
    return [*plan.textures, *(name for p in plan.passes for name in p.reads if name in INPUTS)]


def _difference(before: list[str], after: list[str]) -> str:
    comes = [name for name in dict.fromkeys(after) if name not in before]
    goes = [f"-{name}" for name in dict.fromkeys(before) if name not in after]
    return ", ".join(comes + goes)
