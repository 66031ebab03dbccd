# SPDX-License-Identifier: GPL-3.0-or-later
"""Merged surfels are sharpened by what their overlap blurs, and their overhang counts several times at borders."""

import numpy as np
import pytest

from splat_addon.hierarchy import surroundings
from splat_addon.hierarchy.building import build_levels

from .conftest import make_surfels, sheet

SPACING = 0.04


def first_level(colors, **fields):
    """The first level's merged surfels of a sheet with these colours, away from its borders."""
    positions, normals = sheet(count=90, spacing=SPACING)
    given = np.column_stack([np.repeat(colors(positions)[:, None], 3, axis=1), np.ones(len(positions))])
    fields = {name: of(positions) for name, of in fields.items()}
    nodes, _, levels, _ = build_levels(make_surfels(positions, normals, 1.25 * SPACING, colors=given, **fields))
    some = np.arange(int((levels[0].counts > 1).sum()))
    inner = np.abs(nodes.positions[some, :2] - 45 * SPACING).max(axis=1) < 33 * SPACING
    return nodes, some[inner]


def drawn(nodes, rows):
    """The colours that a picture shows at the centres of these merged surfels."""
    apart = nodes.positions[rows][:, None, :2] - nodes.positions[rows][None, :, :2]
    e2 = (apart**2).sum(axis=2) / nodes.radius[rows] ** 2
    weights = np.where(e2 <= 1, np.exp(-2 * e2), 0)
    return weights @ nodes.colors[rows, 0] / weights.sum(axis=1)


def wave(positions):
    """A wave of seven cells."""
    return 0.5 + 0.05 * np.sin(2 * np.pi * positions[:, 0] / (21 * SPACING))


def test_a_wave_loses_less_of_its_height(monkeypatch):
    def lost():
        nodes, rows = first_level(wave)
        inner = np.abs(nodes.positions[rows, :2] - 45 * SPACING).max(axis=1) < 25 * SPACING
        truth, shown = wave(nodes.positions[rows[inner]].astype(float)) - 0.5, drawn(nodes, rows)[inner] - 0.5
        return 1 - (truth @ shown) / (truth @ truth)

    sharp = lost()
    monkeypatch.setattr(surroundings, "_MOST_CHANGE", np.float32(1e-9))
    assert 0 < sharp < 0.6 * lost()


def test_what_is_even_stays_as_it_is():
    nodes, rows = first_level(lambda positions: np.full(len(positions), 0.3))
    assert np.abs(nodes.colors[rows, 0] - 0.3).max() < 1e-6


def test_other_materials_do_not_count():
    """Each half of the sheet has one colour and one material."""

    def left(positions):
        return positions[:, 0] < 45 * SPACING

    nodes, rows = first_level(lambda p: np.where(left(p), 0.2, 0.8), materials=lambda p: left(p).astype(int))
    assert np.abs(nodes.colors[rows, 0] - np.where(nodes.materials[rows] == 1, 0.2, 0.8)).max() < 1e-6


@pytest.mark.parametrize("contrast", [1.0, 100.0])
def test_a_pattern_as_fine_as_the_cells_is_hardly_sharpened(contrast, monkeypatch):
    def colors(positions):
        return contrast * (np.floor(positions[:, 0] / (3.9 * SPACING)) % 2)

    sharp, rows = first_level(colors)
    monkeypatch.setattr(surroundings, "_MOST_CHANGE", np.float32(1e-9))
    plain, _ = first_level(colors)
    assert 0 < np.abs(sharp.colors[rows] - plain.colors[rows]).max() < 0.1 and sharp.colors.min() >= 0


@pytest.mark.parametrize("other", ["none", "a wall", "a slope"])
def test_overhang_counts_several_times_at_borders_and_creases(other, monkeypatch):
    """Half of a sheet ends, or goes on upwards, steeply or hardly."""
    positions, normals = sheet(count=90, spacing=SPACING)
    positions[:, :2] += np.random.default_rng(0).normal(0, SPACING / 10, (len(positions), 2))
    along = positions[:, 0] - 44.5 * SPACING
    right, bend = along >= 0, {"none": 0, "a wall": np.pi / 2, "a slope": 0.1}[other]
    positions[right, 0] = 44.5 * SPACING + along[right] * np.cos(bend)
    positions[right, 2], normals[right] = along[right] * np.sin(bend), (-np.sin(bend), 0, np.cos(bend))
    kept = ~right | (other != "none")
    # cells begin at the lowest corner; with a surfel there they end between samples
    positions, normals = np.vstack([positions[kept], [[-SPACING / 2] * 3]]), np.vstack([normals[kept], [[0, 0, 1]]])
    surfels = make_surfels(positions, normals, 1.25 * SPACING)
    nodes, errors, levels, _ = build_levels(surfels)
    monkeypatch.setattr(surroundings, "AT_BORDERS", 1)
    counts_more = errors[:, 1] > 1.5 * build_levels(surfels)[1][:, 1]
    first = np.arange(int((levels[0].counts > 1).sum()))
    (x, y), level = (nodes.positions[first, :2] - 45 * SPACING).T / SPACING, nodes.positions[first, 2] < SPACING / 2
    amid = (np.abs(y) < 30) & level
    assert counts_more[first[amid & (x < -6) & (x > -30)]].mean() < 0.15
    beside = counts_more[first[amid & (x < 0) & (x > -3)]].mean()
    assert beside < 0.2 if other == "a slope" else beside > 0.7


def test_surfels_that_are_crowded_on_one_place_stay_finite():
    """So many face every way that a merged surfel may not be among its own candidates."""
    rng, count = np.random.default_rng(7), 3000
    places, normals, half = rng.normal(size=(count, 3)), rng.normal(size=(count, 3)), rng.uniform(0.1, 2, (count, 2))
    nodes, errors, _, _ = build_levels(make_surfels(places, normals, half, materials=rng.integers(0, 9, count)))
    assert len(nodes) and np.isfinite(errors).all() and np.isfinite(nodes.colors).all()
