# SPDX-License-Identifier: GPL-3.0-or-later
"""The papers' figures, drawn with our models and scenes: for each its name, the paper's caption in short, and
the pictures.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from bench.papers.figures import of_2003, of_2005, of_2006, of_view_independent
from measuring.models import in_view, load
from splat_addon.rendering import Renderer, Settings
from splat_addon.sampling import PLAIN, sample_mesh


def figures(renderer: Renderer, models: Path, size: int) -> Iterator[tuple[str, str, list[np.ndarray], int]]:
    """(name, caption, pictures, enlargement) for each figure. size: pixels along an edge of a model's picture."""

    def draw(shot, settings: Settings, **choices) -> np.ndarray:
        return renderer.render(*shot, replace(settings, **choices)).color

    def model(name: str, resolution: int, **view):
        return in_view(_surfels(models / name, resolution), size, **view)

    yield from of_2003.figures(draw, renderer.render, model, size)
    yield from of_2005.figures(draw, renderer, model, size)
    yield from of_2006.figures(draw, renderer.render, size)
    yield from of_view_independent.figures_of_models(draw, model)
    yield from of_view_independent.figures(draw, size)
    yield from of_view_independent.figures_of_sampling(draw, models, size)


@cache
def _surfels(path: Path, resolution: int):
    return sample_mesh(load(path), resolution=resolution, **PLAIN)
