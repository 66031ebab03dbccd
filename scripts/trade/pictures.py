# SPDX-License-Identifier: GPL-3.0-or-later
"""What the numbers look like: the truth and some choices side by side, and under each the map of its FLIP."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

from splat_addon.reference.metrics import srgb
from splat_addon.rendering import Frame, Settings

from .choices import label
from .truth import flip_map, mean_flip

CAPTION = 26


def save_differences(frames: dict[Settings, Frame], truth: Frame, path: Path) -> None:
    """The truth, then a column for each frame; row 0 of a frame is at the bottom, of a file at the top."""
    height, width = truth.color.shape[:2]
    sheet = Image.new("RGB", (width * (len(frames) + 1), 2 * height + CAPTION), "white")
    draw = ImageDraw.Draw(sheet)
    _paste(sheet, draw, 0, srgb(truth.color[..., :3]), "exact, Gaussian pixel")
    for column, (settings, frame) in enumerate(frames.items(), 1):
        flip = mean_flip(frame.color, truth.color)
        _paste(sheet, draw, column * width, srgb(frame.color[..., :3]), f"{label(settings)}\nFLIP {flip:.4f}")
        sheet.paste(_image(flip_map(frame.color, truth.color)), (column * width, CAPTION + height))
    sheet.quantize(256).save(path, optimize=True)


def _paste(sheet, draw, x: int, picture: np.ndarray, caption: str) -> None:
    draw.text((x + 2, 1), caption, fill="black")
    sheet.paste(_image(picture), (x, CAPTION))


def _image(picture: np.ndarray) -> Image.Image:
    values = np.clip(np.nan_to_num(picture), 0, 1)
    return Image.fromarray((255 * values[::-1] + 0.5).astype(np.uint8))
