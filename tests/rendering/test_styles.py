# SPDX-License-Identifier: GPL-3.0-or-later
"""Materials with ramps and lines of their own are drawn as a picture that has these for all."""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference.scenes import torus
from splat_addon.rendering import (
    Camera,
    Instance,
    Light,
    Lines,
    LineStyle,
    Material,
    PolygonInstance,
    Ramp,
    Renderer,
    Scene,
    Settings,
    Style,
    look_at,
    make_polygons,
    plan,
)
from splat_addon.rendering.passes.sums import MAX_STYLES
from splat_addon.rendering.upload.packing import style_moments
from splat_addon.sampling import TriangleMesh
from tests.plain import sample_mesh

SIZE = (48, 32)
RAMP = Ramp(np.array([(0.1, 0.0, 0.3), (0.4, 0.5, 0.1), (1.0, 0.9, 0.7)]))
FAST = {"supersampling": 1, "shadow_resolution": 0}
#: 8 pixels a unit.
FRONT = Camera.orthographic(look_at((0, -10, 0), (0, 0, 0)), 4.0, SIZE, near=0.1, far=30)


@pytest.fixture(scope="module")
def ring():
    scene, camera = torus(count=2000, size=SIZE)
    return replace(scene, lights=(Light("sun", energy=2.0, direction=(0.3, 0.5, -1)),), world=(0.1, 0.1, 0.1)), camera


@pytest.fixture
def picture(on_device):
    """picture(scene, camera, **settings) -> (h, w, 3)."""

    def render(scene, camera, **settings):
        chosen = Settings(**FAST | settings)
        return on_device(lambda device: Renderer(device).render(scene, camera, chosen)).color[..., :3]

    return render


def styled(scene, style):
    instances = (replace(i, materials=tuple(replace(m, style=style) for m in i.materials)) for i in scene.surfels)
    return replace(scene, surfels=tuple(instances))


@pytest.mark.parametrize(
    "how", [{"method": "mip"}, {"method": "quad"}, {"method": "quad", "lights_splats": True}], ids=str
)
def test_a_material_with_a_ramp_is_shaded_as_a_picture_with_that_ramp(how, ring, picture):
    scene, camera = ring
    expected = picture(scene, camera, shading="ramp", ramp=RAMP, **how)
    found = picture(styled(scene, Style(ramp=RAMP)), camera, shading="principled", **how)
    assert np.abs(found - expected).max() < 1e-5
    assert np.abs(found - picture(scene, camera, shading="principled", **how)).max() > 0.1
    # over another ramp, of other length
    assert np.abs(picture(styled(scene, Style(ramp=RAMP)), camera, shading="ramp", **how) - expected).max() < 1e-5


def test_a_material_has_lines_of_its_own_or_none(ring, picture):
    scene, camera = ring
    how = {"method": "mip", "shading": "flat"}
    plain, red = picture(scene, camera, **how), Lines(3.0, (1.0, 0.0, 0.0))
    expected = picture(scene, camera, lines=red, **how)
    own = styled(scene, Style(line=LineStyle(3.0, (1.0, 0.0, 0.0))))
    for others in (None, Lines(1.0)):
        assert np.abs(picture(own, camera, lines=others, **how) - expected).max() < 1e-5
    none = styled(scene, Style(line=LineStyle(0.0)))
    assert np.abs(picture(none, camera, lines=red, **how) - plain).max() < 1e-4
    assert np.abs(expected - plain).max() > 0.1


def sheet(low, high, color, style=None, resolution=40):
    """A square in x and z that faces the viewer."""
    x, z = (low, high), (-1.0, 1.0)
    corners = np.array([(x[0], 0, z[0]), (x[1], 0, z[0]), (x[1], 0, z[1]), (x[0], 0, z[1])])
    surfels = sample_mesh(TriangleMesh(corners, np.array([(0, 1, 2), (0, 2, 3)])), resolution=resolution)
    colors = np.tile(np.float32([*color, 1]), (len(surfels), 1))
    return Instance(replace(surfels, colors=colors), materials=(Material(style=style or Style()),))


def test_where_styles_blend_each_has_its_share(picture):
    """Two sheets in one place: shares are seen as colours without light."""
    a, b = (Ramp(np.tile(np.float64(color), (2, 1))) for color in ((1, 0, 0), (0, 0, 1)))
    for numbers in ([], [Ramp(RAMP.colors * k) for k in np.linspace(0.1, 0.9, 30)]):
        others = [replace(sheet(9, 10, (1, 1, 1), Style(ramp=ramp), 2)) for ramp in numbers]
        sheets = [sheet(-1.5, 1.5, (1, 1, 1), Style(ramp=ramp), size) for ramp, size in ((a, 20), (b, 33))]
        colored = [sheet(-1.5, 1.5, color, None, size) for color, size in (((1, 0, 0), 20), ((0, 0, 1), 33))]
        found = picture(Scene((sheets[0], *others, sheets[1])), FRONT, method="quad", shading="ramp")
        shares = picture(Scene(tuple(colored)), FRONT, method="quad", shading="flat")
        assert ((shares[8:-8, 16:-16, 0] > 0.1) & (shares[8:-8, 16:-16, 2] > 0.1)).mean() > 0.9
        assert np.abs(found - shares)[8:-8, 16:-16].max() < 2e-3


@pytest.mark.parametrize("are_polygons", [False, True])
def test_a_line_lies_where_groups_meet_in_one_plane(are_polygons, picture):
    def scene(group):
        parts = sheet(-1.5, 0, (1, 1, 1)), sheet(0, 1.5, (1, 1, 1), Style(group=group))
        if not are_polygons:
            return Scene(parts)
        corners = ((x, 0, z) for x in (0, 1.5) for z in (-1.0, 1.0))
        mesh = TriangleMesh(np.array([*corners]), np.array([(0, 2, 3), (0, 3, 1)]))
        return Scene(
            parts[:1],
            polygons=(PolygonInstance(make_polygons(mesh.positions, mesh.triangles), materials=parts[1].materials),),
        )

    how = {"method": "mip", "shading": "flat", "lines": Lines(2.0, (1.0, 0.0, 0.0))}
    met, alike = (picture(scene(group), FRONT, **how)[12:20, 14:34, 1] for group in (1, 0))
    assert alike.min() > 0.75
    met = 1 - met / alike
    assert np.allclose(met.sum(axis=1), 2.0, atol=0.7)
    assert np.abs(met @ np.arange(20) / met.sum(axis=1) - 9.5).max() < 0.6


def test_what_has_no_room_is_said(ring):
    scene, camera = ring
    assert "STYLES" not in dict(plan(scene, camera, Settings()).features)
    assert "STYLES" in dict(plan(styled(scene, Style(ramp=RAMP)), camera, Settings()).features)
    many = tuple(
        replace(scene.surfels[0], materials=(Material(style=Style(group=group)),)) for group in range(MAX_STYLES + 1)
    )
    skipped = dict(plan(replace(scene, surfels=many), camera, Settings()).skipped)
    assert f"{MAX_STYLES + 1} different" in skipped["styles"]


def test_two_styles_follow_from_the_moments_of_their_mixture():
    """The closed form of the shader, in its precision, for as many styles as a picture has room for."""
    styles = tuple(Style(group=group) for group in range(MAX_STYLES))
    for one, other in ((0, 1), (0, 511), (200, 201), (17, 400)):
        first, second = (np.array(style_moments(styles[k], styles)[:3]) for k in (one, other))
        for share in (0.1, 0.5, 0.9):
            m = np.float32(first * (1 - share) + second * share)
            variance = m[1] - m[0] * m[0]
            lean = np.float32(0.5) * (m[2] - m[0] * (3 * variance + m[0] * m[0])) / variance
            reach = np.sqrt(variance + lean * lean)
            numbers = np.rint((m[0] + lean + np.array([-reach, reach]) + 1) / 2 * (MAX_STYLES - 1))
            if abs(one - other) > 1:
                assert numbers.tolist() == [one, other]
