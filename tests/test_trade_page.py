# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of docs/evidence/trade.md and docs/choose.md name methods and presets that exist, with the presets'
settings, and no choice that they show is better than a preset in all respects."""

import re
from pathlib import Path

import pytest

from splat_addon.rendering import PRESETS
from splat_addon.rendering.methods import METHODS
from splat_addon.sampling import REDUCTIONS
from splat_addon.trade.choices import NUMBERS

DOCS = Path(__file__).resolve().parents[1] / "docs"
LABELS = {method.label: name for name, method in METHODS.items()}
FILTERS = ("Gaussian", "Box")


def tables(page: str) -> list[list[list[str]]]:
    """The tables of a page: rows of cells, the heads first."""
    blocks = re.findall(r"(?:^\|.*\|\n)+", (DOCS / page).read_text(encoding="utf-8"), re.MULTILINE)
    rows = ([[cell.strip() for cell in line.strip("|").split("|")] for line in block.splitlines()] for block in blocks)
    return [[head, *body] for head, _, *body in rows]


def measured(pixel: str) -> dict[str, tuple[float, list[float]]]:
    """What the page's table for a pixel filter holds: row -> (time, FLIP of each scene), of rows with a time."""
    (table,) = (each for each in tables("evidence/trade.md") if each[0][0] == f"{pixel} pixel")
    rows = (row for row in table[1:] if row[-1])
    return {row[0]: (float(row[-1].split()[0]), [float(cell.split("/")[1]) for cell in row[1:-1]]) for row in rows}


def method_of(label: str) -> str:
    """The method that a row's label names."""
    plain = re.sub(r"\*\*|\(.*?\)", "", label).strip()
    found = [name for name in LABELS if re.match(rf"{re.escape(name)}\b(?! in)", plain, re.IGNORECASE)]
    return max(found, key=len, default="")


@pytest.mark.parametrize("pixel", FILTERS)
def test_every_row_with_a_time_names_a_method(pixel):
    assert [label for label in measured(pixel) if not method_of(label)] == []


@pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)
def test_a_preset_is_shown_with_its_settings(preset):
    (label,) = {label for label in measured("Gaussian") if f"({preset.label})" in label}
    samples = preset.values["supersampling"]
    assert LABELS[method_of(label)] == preset.values["method"] and f"{samples} x {samples}" in label


@pytest.mark.parametrize("preset", PRESETS.values(), ids=PRESETS)
def test_no_choice_is_better_than_a_preset_in_all_respects(preset):
    """Under one of the pixel filters nothing is as fast and as close in every scene."""

    def is_dominated(pixel):
        rows = measured(pixel)
        (own,) = (label for label in rows if f"({preset.label})" in label)
        time, flips = rows.pop(own)
        return any(t <= time and all(a <= b for a, b in zip(errors, flips, strict=True)) for t, errors in rows.values())

    assert not all(map(is_dominated, FILTERS))


@pytest.mark.parametrize(("page", "head"), [("methods", "method"), ("numerics", "formats")])
def test_other_pages_tables_name_methods(page, head):
    (table,) = (each for each in tables(f"evidence/{page}.md") if each[0][0] == head)
    assert len(table) > 3 and all(method_of(row[0]) for row in table[1:])


def column(head: str, name: str) -> set[str]:
    """The cells of a column of the page's table that begins with a head."""
    (table,) = (each for each in tables("evidence/trade.md") if each[0][0] == head)
    return {row[table[0].index(name)] for row in table[1:]}


def test_settings_reductions_and_presets_of_the_page_exist():
    known = {number.name(value) for number in NUMBERS for value in number.values}
    assert column("scene", "setting") <= known | {"As set"}
    assert {name.replace(" ", "_") for name in column("reduction", "reduction")} <= set(REDUCTIONS)
    assert column("preset", "preset") == {preset.label for preset in PRESETS.values()}


def test_choose_names_the_presets_and_the_methods():
    presets, methods = (next(t for t in tables("choose.md") if t[0][0] == name) for name in ("preset", "method"))
    shown = [re.match(r"\*\*(\w+)\*\*", row[0])[1] for row in presets[1:]]
    assert shown == [preset.label for preset in PRESETS.values()]
    assert all(row[0] in LABELS for row in methods[1:])
