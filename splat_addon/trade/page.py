# SPDX-License-Identifier: GPL-3.0-or-later
"""Measurements as one HTML page that needs no other file: a table, a plot and the pictures with their differences."""

from __future__ import annotations

import base64
import math
import struct
import zlib
from collections.abc import Sequence
from html import escape

import numpy as np

from ..differences import srgb
from .exact import ExactPictures
from .measuring import Row

_STYLE = """
body{font:15px/1.45 system-ui,sans-serif;margin:2rem auto;max-width:72rem;padding:0 1rem;color:#222;background:#fff}
table{border-collapse:collapse}td,th{padding:.25rem .7rem;border-bottom:1px solid #ddd;text-align:right}
td:first-child,th:first-child{text-align:left}tr.best td{font-weight:600}
figure{display:inline-block;margin:0 1rem 1rem 0;vertical-align:top}
img{display:block;max-width:34rem;image-rendering:pixelated}
svg text{font:13px system-ui,sans-serif;fill:#222}
"""

#: Colours of the plot by pixel filter, which are told apart without seeing colours by their shape too.
_COLORS = {"gaussian": "#2458a6", "box": "#b8541f"}


def page(title: str, about: str, rows: Sequence[Row], exact: ExactPictures) -> str:
    """The page. about: a sentence on the scene, its size and the machine."""
    best = frontier(rows)
    converged = ", ".join(f"{db:.0f} dB ({name} pixel)" for name, db in exact.converged.items())
    parts = [
        f"<!DOCTYPE html><html lang=en><meta charset=utf-8><title>{escape(title)}</title><style>{_STYLE}</style>",
        f"<h1>{escape(title)}</h1><p>{escape(about)}</p>",
        "<p>Each picture is compared with the exact picture of its pixel filter. FLIP is 0 for equal pictures; below "
        f"0.01 few people see a difference. The exact pictures are converged to about {converged}. Bold rows are the "
        "best for their time. Rows that name one setting have all others as set.</p>",
        _table(rows, best),
        "<h2>Error against time</h2><p>Squares have a box pixel, discs a Gaussian one.</p>",
        _plot(rows, best),
        "<h2>Pictures and their differences</h2>",
    ]
    for row in rows:
        caption = f"{escape(row.choice.name)}: FLIP {row.flip:.4f}, {_db(row.psnr)} dB, {row.seconds:.3g} s"
        images = (_embedded(srgb(row.color[..., :3])), _embedded(magma(row.difference)))
        parts += [f"<figure><img src={image} alt=''><figcaption>{caption}</figcaption></figure>" for image in images]
    return "\n".join([*parts, "</html>", ""])


def frontier(rows: Sequence[Row]) -> set[int]:
    """The places of the rows that no other is both faster and closer than."""
    return {
        place
        for place, row in enumerate(rows)
        if not any(
            other.seconds <= row.seconds
            and other.flip <= row.flip
            and (other.seconds, other.flip) != (row.seconds, row.flip)
            for other in rows
        )
    }


def _db(value: float) -> str:
    return f"{value:.1f}" if math.isfinite(value) else "equal"


_COLUMNS = ("", "seconds", "times the first", "FLIP", "dB", "pixel", "FLIP, other pixel", "surfels", "MiB of textures")


def _table(rows: Sequence[Row], best: set[int]) -> str:
    lines = ["<table><tr>" + "".join(f"<th>{column}</th>" for column in _COLUMNS) + "</tr>"]
    for place, row in enumerate(rows):
        cells = (
            escape(row.choice.name),
            f"{row.seconds:.3g}",
            f"{row.seconds / rows[0].seconds:.2f}",
            f"{row.flip:.4f}",
            _db(row.psnr),
            row.filter,
            f"{row.others[0]:.4f}",
            f"{row.splats:,}",
            f"{row.bytes / 2**20:.1f}",
        )
        shown = "".join(f"<td>{cell}</td>" for cell in cells)
        lines.append(f"<tr class=best>{shown}</tr>" if place in best else f"<tr>{shown}</tr>")
    return "\n".join([*lines, "</table>"])


_WIDTH, _HEIGHT, _MARGIN = 720, 400, 60


def _plot(rows: Sequence[Row], best: set[int]) -> str:
    """FLIP against seconds, both logarithmic."""
    times = np.log10([row.seconds for row in rows])
    errors = np.log10([max(row.flip, 1e-5) for row in rows])
    x = _placed(times, _MARGIN, _WIDTH - 200)
    y = _placed(-errors, _MARGIN / 2, _HEIGHT - _MARGIN)
    line = sorted(best, key=lambda place: x[place])
    points = " ".join(f"{x[k]:.0f},{y[k]:.0f}" for k in line)
    shapes = [f'<polyline points="{points}" fill="none" stroke="#bbb"/>']
    for place, row in enumerate(rows):
        shapes.append(_mark(x[place], y[place], row))
    shapes += [f'<text x="{x[k] + 8:.0f}" y="{y[k] - 6:.0f}">{escape(rows[k].choice.name)}</text>' for k in line]
    bottom, right = _HEIGHT - 15, _WIDTH - 200
    shapes += [
        f'<text x="{_MARGIN}" y="{bottom}">{min(row.seconds for row in rows):.2g} s</text>',
        f'<text x="{right - 40}" y="{bottom}">{max(row.seconds for row in rows):.2g} s</text>',
        f'<text x="4" y="{_MARGIN / 2}">{max(row.flip for row in rows):.3f}</text>',
        f'<text x="4" y="{_HEIGHT - _MARGIN}">{min(row.flip for row in rows):.4f}</text>',
    ]
    return f'<svg viewBox="0 0 {_WIDTH} {_HEIGHT}" width="{_WIDTH}" role="img">' + "\n".join(shapes) + "</svg>"


def _mark(x: float, y: float, row: Row) -> str:
    """A square for the box pixel, a disc for the Gaussian; pointing at it shows its name."""
    about = f'fill="{_COLORS[row.filter]}"><title>{escape(row.choice.name)}</title>'
    if row.filter == "box":
        return f'<rect x="{x - 4:.0f}" y="{y - 4:.0f}" width="8" height="8" {about}</rect>'
    return f'<circle cx="{x:.0f}" cy="{y:.0f}" r="4.5" {about}</circle>'


def _placed(values: np.ndarray, first: float, last: float) -> np.ndarray:
    low, high = values.min(), values.max()
    return first + (values - low) / max(high - low, 1e-9) * (last - first)


#: Black, purple, red, orange, pale yellow: ever lighter, so that it reads without colour too.
_MAGMA = np.array(((0, 0, 4), (81, 18, 124), (183, 55, 121), (252, 137, 97), (252, 253, 191)), float) / 255


def magma(values: np.ndarray) -> np.ndarray:
    """(h, w) 0 to 1 -> (h, w, 3) colours as a screen shows them, ever lighter."""
    steps = np.linspace(0, 1, len(_MAGMA))
    return np.stack([np.interp(values, steps, _MAGMA[:, channel]) for channel in range(3)], axis=-1)


def _embedded(shown: np.ndarray) -> str:
    return "data:image/png;base64," + base64.b64encode(png(shown)).decode("ascii")


def png(shown: np.ndarray) -> bytes:
    """(h, w, 3) 0 to 1, as a screen shows them, row 0 at the bottom -> a PNG of 8 bits (W3C, Portable Network
    Graphics)."""
    height, width = shown.shape[:2]
    pixels = np.round(np.clip(np.nan_to_num(shown[::-1]), 0, 1) * 255).astype(np.uint8)
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    chunks = ((b"IHDR", head), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data)) for name, data in chunks
    )
