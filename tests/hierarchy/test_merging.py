# SPDX-License-Identifier: GPL-3.0-or-later
"""Which surfels merge into one, and what the merged surfel looks like."""

import numpy as np
import pytest

from splat_addon.hierarchy import build_hierarchy
from splat_addon.quaternions import quaternion_axes
from splat_addon.surfels import empty_surfels

from .conftest import ball, cut_sheet, leaves_of, make_surfels, sheet


def test_nothing_is_merged_across_materials():
    positions, normals = sheet()
    materials = np.random.default_rng(0).integers(0, 3, len(positions))
    surfels = make_surfels(positions, normals, materials=materials)
    below, nodes, _, _ = leaves_of(surfels)
    assert len(nodes)
    for k, material in enumerate(nodes.materials):
        assert (materials[below[len(surfels) + k]] == material).all()


@pytest.mark.parametrize("gap", [1e-5, 1e-3, 0.05])
def test_the_sides_of_a_thin_sheet_stay_two(gap):
    (top, up), (bottom, down) = sheet(height=gap / 2), sheet(height=-gap / 2, normal=(0, 0, -1))
    surfels = make_surfels(np.concatenate([top, bottom]), np.concatenate([up, down]))
    below, nodes, errors, _ = leaves_of(surfels)
    assert len(nodes) > 100
    for k in range(len(nodes)):
        sides = surfels.positions[below[len(surfels) + k], 2] > 0
        assert sides.all() or not sides.any()
    assert errors[:, 0].max() < 1e-4


def test_sheets_of_one_side_stay_two_while_a_gap_shows():
    (low, up), (high, _) = sheet(height=0.0), sheet(height=0.2)
    surfels = make_surfels(np.concatenate([low, high]), np.concatenate([up, up]))
    below, nodes, errors, _ = leaves_of(surfels)
    for k in range(len(nodes)):
        heights = np.unique(surfels.positions[below[len(surfels) + k], 2])
        assert len(heights) == 1 or (errors[k, 0] >= 0.1 and nodes.radius[k] > 0.4)


def test_a_flat_sheet_becomes_larger_discs_that_cover_it():
    surfels = make_surfels(*sheet(count=45))
    _, nodes, errors, levels = leaves_of(surfels)
    first = nodes.scales[: int((levels[0].counts > 1).sum())]
    cell = 3 * 0.04
    assert (first.min(axis=1) >= np.sqrt(0.5) * 0.04).all() and np.median(first) >= np.sqrt(0.5) * cell
    assert np.median(first) <= cell
    assert errors[:, 0].max() < 1e-4
    assert np.allclose(nodes.geometric_normals(), (0, 0, 1), atol=1e-5)


def test_colours_are_means_of_light_and_of_what_is_let_through():
    positions, normals = sheet(count=3, spacing=0.01)
    colors = np.tile((1.0, 0.0, 0.0, 1.0), (9, 1))
    colors[:3] = 0.0, 4.0, 0.0, 0.25
    nodes = build_hierarchy(make_surfels(positions, normals, colors=colors)).nodes
    red, green = 6 / 9, 3 / 9 * 0.25
    assert np.allclose(nodes.colors[0], (red / (red + green), 4 * green / (red + green), 0, red + green), atol=1e-4)


def test_what_the_mean_normal_loses_in_length_is_roughness():
    """Two normals at angle b to their mean give a length of cos b, and alpha^2 = alpha0^2 + 2 (1 - cos b) / cos b."""
    positions, up = sheet(count=3, spacing=0.01)
    tilt = np.array([(0.6 if k % 2 else -0.6, 0, 0.8) for k in range(9)])
    roughness = np.full(9, 0.2)
    flat = build_hierarchy(make_surfels(positions, up, roughness=roughness)).nodes
    bent = build_hierarchy(make_surfels(positions, up, shading=tilt, roughness=roughness)).nodes
    assert np.allclose(flat.roughness, 0.2, atol=1e-3)
    length = np.linalg.norm(tilt.mean(axis=0))
    assert np.allclose(bent.roughness[0], (0.2**4 + 2 * (1 - length) / length) ** 0.25, atol=1e-3)


def test_texture_coordinates_follow_the_surface_and_end_where_a_chart_does():
    positions, normals = sheet(count=30)
    surfels = make_surfels(positions, normals)
    x, y = surfels.half_axes()
    chart = np.where(positions[:, 0] > 0.58, 0.5, 0.0)
    fields = {
        "uvs": 0.1 * positions[:, :2] + np.column_stack([chart, chart]),
        "uv_along_x": 0.1 * x[:, :2],
        "uv_along_y": 0.1 * y[:, :2],
    }
    surfels = make_surfels(positions, normals, **fields)
    below, nodes, _, _ = leaves_of(surfels)
    along, (u, v) = np.abs(nodes.uv_along_x).sum(axis=1) + np.abs(nodes.uv_along_y).sum(axis=1), nodes.half_axes()
    for k in range(len(nodes)):
        charts = np.unique(chart[below[len(surfels) + k]])
        if len(charts) == 1:
            assert np.allclose(nodes.uvs[k], 0.1 * nodes.positions[k, :2] + charts[0], atol=1e-5)
            assert np.allclose(nodes.uv_along_x[k], 0.1 * u[k, :2], atol=1e-5)
            assert np.allclose(nodes.uv_along_y[k], 0.1 * v[k, :2], atol=1e-5)
        else:
            assert along[k] == 0
    assert (along == 0).any() and (along > 0).any()


def test_it_takes_at_most_two_fifths_of_the_surfels_memory():
    count = 100_000
    surfels = make_surfels(*ball(count), half=1.25 * (4 * np.pi / count) ** 0.5)
    hierarchy = build_hierarchy(surfels)
    assert hierarchy.nbytes <= 0.4 * sum(array.nbytes for array in surfels.arrays().values())


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_to_merge_are_a_hierarchy_too(count):
    surfels = make_surfels(*ball(count)) if count else empty_surfels()
    hierarchy = build_hierarchy(surfels)
    assert len(hierarchy) == 0 and hierarchy.entries.tolist() == list(range(count))


def test_sets_of_any_scale_and_offset_give_the_same_tree():
    count = 3000
    positions, normals = ball(count)
    half = 1.25 * (4 * np.pi / count) ** 0.5
    plain = build_hierarchy(make_surfels(positions, normals, half))
    for scale in (2.0**-40, 2.0**40):
        other = build_hierarchy(make_surfels(positions * scale, normals, half * scale))
        assert (other.entries == plain.entries).all()
        assert np.allclose(other.nodes.positions, plain.nodes.positions * scale, rtol=1e-6)


def test_merged_surfels_end_where_theirs_do():
    """A strip whose borders run through the cells."""
    surfels = cut_sheet([(0.3, -0.33), (0.3 + np.pi, -0.33)])
    nodes = build_hierarchy(surfels).nodes
    lines, _ = nodes.clip_lines()
    x, y, _ = quaternion_axes(nodes.rotations)
    way, checked = np.array([np.cos(0.3), np.sin(0.3), 0]), 0
    for number in (0, 1):
        for k in np.flatnonzero(lines[:, number, 2] < 1):
            a, b, c = lines[k, number]
            across = a / nodes.scales[k, 0] * x[k] + b / nodes.scales[k, 1] * y[k]
            # distance from the middle of the sheet's centre line
            border = c / np.linalg.norm(across) - (across @ nodes.positions[k]) / np.linalg.norm(across)
            assert abs(abs(across @ way) / np.linalg.norm(across) - 1) < 1e-3
            assert border == pytest.approx(0.33, abs=2e-3)
            checked += 1
    assert checked > 50
