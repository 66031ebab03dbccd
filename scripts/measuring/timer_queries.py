# SPDX-License-Identifier: GPL-3.0-or-later
"""The time that the graphics device itself spends on draw calls, from OpenGL's timer queries."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from splat_addon.rendering.device import Device


def has_timer_queries(device: Device) -> bool:
    """Whether the device's queries count all of a draw call; those of software OpenGL leave its vertices out."""
    return "llvmpipe" not in device.renderer


@contextmanager
def timed_draws(device: Device) -> Iterator[dict[str, float]]:
    """Milliseconds by name of pipeline, of what is drawn inside the context; complete after it."""
    spent, queries, draw = {}, [], device.draw_triangles

    def timed(pipeline, *arguments, **options):
        query = device._context.query(time=True)
        with query:
            draw(pipeline, *arguments, **options)
        queries.append((pipeline.description.name, query))

    device.draw_triangles = timed
    try:
        yield spent
    finally:
        del device.draw_triangles
    for name, query in queries:
        spent[name] = spent.get(name, 0.0) + query.elapsed / 1e6
