# SPDX-License-Identifier: GPL-3.0-or-later
"""Shows a tree of mixed and added shaders as one surface: the mean of their colours, each with its share.

The rules are those of `shader_mixes`, with numbers instead of nodes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...sampling import Channel, Surface
from .graphs.channels import constant_of, mix_factor
from .socket_ranges import is_radiance
from .surface_shaders import CLEAR, SHADERS, Part, Shader, parts

#: Opacity below which a colour is invisible.
LEAST_OPACITY = 1e-4


@dataclass(frozen=True, eq=False)
class Mean:
    """surface: of plain numbers. sent: (3,) what it emits, also if no picture can represent that. unsure: its channels
    that depend on more than numbers. only: the shader that alone is left of a tree, which can be read by itself."""

    surface: Surface
    sent: tuple[float, float, float]
    unsure: frozenset[str]
    only: Shader | None


def mean_of(shader: Shader) -> Mean:
    """What a tree of shaders looks like."""
    mixed = list(parts(shader, mix_factor))
    alone = mixed[0].shader if len(mixed) == 1 and mixed[0].is_sure and mixed[0].share == 1 else None
    is_read = alone is not None and alone.node.bl_idname in SHADERS
    # mixed with nothing, a tinted Transparent BSDF covers what is behind it
    only = alone if is_read and (alone.node.type not in CLEAR or (alone == shader and not alone.is_clear)) else None
    unsure: set[str] = set() if all(part.is_sure for part in mixed) else {"color", "opacity", "emission"}
    color, emission, through = np.zeros(3), np.zeros(3), 0.0
    for part in mixed:
        if only is None and part.shader.node.type in CLEAR:
            through += part.share
            continue
        opacity = _value(part, "opacity", 1.0, unsure)[0]
        through += part.share * (1 - opacity)
        color += part.share * opacity * _value(part, "color", 0.8, unsure)
        # a Principled shader's alpha fades its emission, too
        emission += part.share * opacity * _value(part, "emission", 0.0, unsure)
    opacity = float(np.clip(1 - through, 0, 1))
    color, emission = (part / opacity if opacity > LEAST_OPACITY else np.zeros(3) for part in (color, emission))
    sent = tuple(emission.tolist())
    shown = Channel(sent) if any(sent) and is_radiance(sent) else None
    return Mean(Surface(Channel((*color.tolist(), opacity)), emission=shown), sent, frozenset(unsure), only)


def _value(part: Part, channel: str, default: float, unsure: set[str]) -> np.ndarray:
    """(3,) plain value of a channel of a shader; its name goes into `unsure` if more than a number feeds it.

    default: of shaders that lack it.
    """
    node = part.shader.node
    if channel == "color" and node.type == "EMISSION":
        return np.zeros(3)
    names = SHADERS.get(node.bl_idname, {}).get(channel, ())
    if not names and channel == "color":
        names = [name for name in ("Color", "Base Color") if name in node.inputs][:1]
    read = np.full(3, 1.0 if names else default)
    for name in names:
        number = constant_of(part.shader, name) if part.shader.socket(name).is_linked else None
        if number is None and part.shader.socket(name).is_linked:
            unsure.add(channel)
        read = read * (part.shader.plain(name).value if number is None else number)
    return read
