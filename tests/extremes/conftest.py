# SPDX-License-Identifier: GPL-3.0-or-later
"""Every fact in this folder holds for every registered method, compared with the float64 truth for the same samples.

All methods must keep hard bounds: no non-finite number, and no empty pixel that the truth covers fully. Methods without
a low-pass must also equal the truth's picture within `LEAST_PSNR`. Cases in which a paper's own formula fails are in
`KNOWN_FAILURES`; the default methods have none.

The default methods draw every case. Of a test with many, each other method draws the first, the last and one of
`SHARE` between, another than the next method's; with `--hypothesis-profile long` it draws all.
"""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import settings as hypothesis_settings

from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings
from splat_addon.rendering.methods import METHODS

#: Methods whose picture is by definition the truth's for the same samples; the others filter.
UNFILTERED = ("quad",)

#: The methods of the presets; they must not fail.
DEFAULTS = ("mip", "quad")

#: Of so many cases between the first and the last, a method that is no default draws one.
SHARE = 4


def _cases(test: str, method: str, *ids) -> tuple[str, ...]:
    """The names of a test's cases, as pytest prints them."""
    return tuple(f"{test}[{method}-{i}]" for i in ids)


_GRAZING, _FLOOR = "test_a_grazing_sheet_is_the_true_one", "test_a_sheet_that_reaches_past_the_viewer_has_no_holes"
_GIANT, _WINDOW = "test_a_giant_floor_reaches_to_its_horizon", "test_a_window_far_off_the_axis_is_the_true_one"
_POSES = "test_the_eye_in_the_surface_sees_no_hole"
_DEPTH, _EYE = "test_depth_is_known_to_a_millionth_at_any_distance", "test_what_lies_before_the_near_plane_alone_is_cut"
_RIM, _BEYOND = (
    "test_a_splat_across_the_near_plane_keeps_its_rim",
    "test_a_splat_across_the_eye_hides_nothing_beyond_its_rim",
)
_NORMALS, _CANCELLED = (
    "test_any_two_normals_in_one_place_give_the_true_light",
    "test_what_rounding_leaves_of_cancelling_normals_is_no_normal",
)
_FACING = "test_a_surface_whose_normals_cancel_faces_the_viewer"
_ALMOST = "test_normals_that_cancel_but_for_a_millionth_have_their_direction"
_SMALL = "test_a_giant_splat_leaves_small_ones_as_they_are"
_PARALLEL = "test_a_parallel_camera_may_stand_in_what_it_sees"

_HIDDEN = "test_no_splat_hides_itself"

_SPRITES = "sprites", "sprites_printed", "sprites_unfiltered"
_NEARS = 0.1, 0.01, 0.0001, 1e-06
_SCALES = 1e-18, 1e-12, 1e-06, 1e6, 1e12, 1e18
_OFF_AXIS = (60, 61, 62, 64, 65, 67, 68, 71, 72, 78, 79)

#: why -> the cases that fail for it, each with its method. Strict: one that passes must leave the table.
KNOWN_FAILURES = {
    "Botsch and Kobbelt 2003 project in parallel: off the axis a tilted disc is too small, and gaps open": (
        *(case for method in _SPRITES for case in _cases(_GRAZING, method, *_OFF_AXIS)),
        *(case for method in _SPRITES for case in _cases(_FLOOR, method, 0.3, 0.1)),
        *_cases(_FLOOR, "sprites_unfiltered", 0.03, 0.01),
        *(case for method in _SPRITES for case in _cases(_GIANT, method, "1.0-floor", "1.0-both")),
        *_cases(_GIANT, "sprites_unfiltered", "10.0-floor"),
        *(case for method in _SPRITES for case in _cases(_WINDOW, method, 5, 20, 100)),
        *(f"{_POSES}[{method}]" for method in _SPRITES),
        *(case for method in _SPRITES for case in _cases(_HIDDEN, method, "60-0", "60-1e-07", "60-1e-06")),
        *(f"{_HIDDEN}_in_linear_depth[{method}-60]" for method in _SPRITES),
    ),
    "Botsch and Kobbelt 2003, equation 4 as printed: depths are off by a slope in units of the scene, the wrong way": (
        "test_a_wide_clip_range_alone_costs_nothing[sprites_printed-checker]",
        *(f"test_something_at_the_near_plane_costs_nothing[sprites_printed-checker-{n}]" for n in _NEARS),
        *_cases("test_any_epsilon_gives_its_true_picture", "sprites_printed", "0-40", "1e-07-40"),
        *_cases(_HIDDEN, "sprites_printed", "85-0", "85-1e-07", "85-1e-06"),
        f"{_HIDDEN}_in_linear_depth[sprites_printed-85]",
        *_cases("test_a_scaled_world_looks_the_same", "sprites_printed", *(f"perspective-{s}" for s in _SCALES)),
        *_cases("test_a_scaled_world_looks_the_same", "sprites_printed", *(f"orthographic-{s}" for s in _SCALES)),
        *_cases("test_surfels_may_be_stored_at_any_scale", "sprites_printed", *_SCALES),
    ),
    "Botsch and Kobbelt 2003, equation 1 as printed: splats have half their size, and gaps open between them": (
        *_cases("test_a_few_surfels_far_from_the_others_do_not_set_the_scale", "sprites_printed", "1e-24", "1e+24"),
        *_cases("test_something_at_the_near_plane_costs_nothing", "sprites_printed", "torus-0.1", "torus-1e-06"),
        *_cases(_DEPTH, "sprites_printed", *(10.0**k for k in range(-6, 7))),
        *_cases(
            "test_something_far_behind_costs_a_parallel_camera_nothing",
            "sprites_printed",
            "100.0-False",
            "10000.0-True",
            "1000000.0-True",
        ),
        *_cases("test_ellipses_that_get_thinner_are_the_true_ones", "sprites_printed", "0-1", "1.0-1"),
        *_cases("test_long_ellipses_at_an_angle_are_the_true_ones", "sprites_printed", "1"),
        *_cases("test_any_epsilon_gives_its_true_picture", "sprites_printed", "0.01-60", "5-60", "100-60"),
        *_cases(_HIDDEN, "sprites_printed", "0-0"),
        *_cases("test_no_splat_hides_itself_in_linear_depth", "sprites_printed", "0"),
        *_cases(_BEYOND, "sprites_printed", "cut by the near plane", "centre far behind", "wholly behind"),
        *_cases("test_a_splat_before_the_near_plane_hides_nothing_when_moved_back", "sprites_printed", "0.9", "0.99"),
        *_cases("test_splats_across_a_wide_field_are_the_true_ones", "sprites_printed", "120", "170"),
        *_cases(_GIANT, "sprites_printed", "1.0-wall"),
        *_cases(_GRAZING, "sprites_printed", "63", "75", "83", "86.5"),
        *_cases(_NORMALS, "sprites_printed", "opposing", "in the plane"),
        *_cases(_CANCELLED, "sprites_printed", "3", "40"),
        *_cases(
            "test_many_layers_give_their_mean",
            "sprites_printed",
            "float32-1-100",
            "float32-1000-90",
            "float16-100-65",
            "float16-5000-0",
        ),
        *_cases("test_a_long_picture_is_the_true_one", "sprites_printed", "8192x16", "16x8192"),
        *_cases(_PARALLEL, "sprites_printed", "0", "1e-12"),
        *_cases("test_beyond_epsilon_nothing_bleeds_through", "sprites_printed", "0.6", "2"),
        "test_a_parallel_camera_within_what_it_sees_reaches_to_a_thousand[sprites_printed]",
        "test_coincident_sheets_mix_evenly[sprites_printed]",
    ),
    "Botsch and Kobbelt 2003, unfiltered: a splat lies at its centre, is there where that is and has its depth": (
        *_cases(_EYE, "sprites_unfiltered", "through the eye's plane", "centre behind the camera", "centre far behind"),
        *_cases(_RIM, "sprites_unfiltered", 0, 20, 40, 60, 80, 100),
        "test_a_depth_beyond_that_of_nothing_is_kept[sprites_unfiltered]",
    ),
    "Botsch and Kobbelt 2003, unfiltered: the nearest splat wins, and nothing blends": (
        *_cases(_CANCELLED, "sprites_unfiltered", 3, 7, 40),
        *(f"{test}[sprites_unfiltered]" for test in (_FACING, "test_coincident_sheets_mix_evenly")),
        *_cases(_ALMOST, "sprites_unfiltered", "0.0001", "3e-06"),
    ),
    "Guennebaud et al. 2006 as printed: the tangents of a disc that faces the ray are 0 / 0, and it is not drawn": (
        *_cases(_DEPTH, "homogeneous_printed", *(10.0**k for k in range(-6, 7))),
        *_cases("test_long_ellipses_at_an_angle_are_the_true_ones", "homogeneous_printed", 1),
        *_cases(_BEYOND, "homogeneous_printed", "cut by the near plane", "through the eye's plane"),
        *_cases(_BEYOND, "homogeneous_printed", "centre behind the camera", "centre far behind"),
        *_cases(_BEYOND, "homogeneous_printed", "through the eye", "wholly behind"),
        *_cases(_GIANT, "homogeneous_printed", *(f"{10.0**k}-{kind}" for k in range(5) for kind in ("wall", "both"))),
        *_cases(_NORMALS, "homogeneous_printed", "opposing", "cancelling in the plane"),
        *_cases(_NORMALS, "homogeneous_printed", "almost cancelling", "in the plane"),
        *_cases(_CANCELLED, "homogeneous_printed", 3, 7, 40),
        *_cases(_PARALLEL, "homogeneous_printed", 0, "1e-30", "1e-12"),
        *(f"{test}[homogeneous_printed]" for test in (_FACING, _SMALL)),
        *_cases(_ALMOST, "homogeneous_printed", "0.0001", "3e-06"),
    ),
    "Botsch et al. 2005 as printed: the square around a splat is that of one on the axis, and cuts others": (
        *_cases(_WINDOW, "raycast_printed", 5, 20, 100),
        "test_a_long_picture_is_the_true_one[raycast_printed-8192x16]",
    ),
    "Zwicker et al. 2001 take a splat's projection as affine: a near or far off one is cut short": (
        *_cases(_GIANT, "ewa", "1.0-floor", "1.0-both"),
        *_cases("test_a_long_picture_is_the_true_one", "ewa", "8192x16"),
        f"{_POSES}[ewa]",
    ),
    "a filter in the picture, or a least angle, keeps an edge-on splat a pixel wide": (
        *(
            f"test_edge_on_nothing_is_drawn[{method}]"
            for method in ("ewa", "raycast", "homogeneous", "homogeneous_printed", "sprites", "sprites_unfiltered")
        ),
    ),
}

#: The names of all collected cases of this folder, of those left out, too.
ALL_CASES = set()

#: dB; measured: 70 and more (docs/evidence/numerics.md). Of 64 x 64 pixels one sample that falls the other way costs
#: 60 dB.
LEAST_PSNR = 50

#: Of the truth, and of every method but the default, which needs one sample. Without a filter a silhouette shows each
#: error of the tolerance, and the truth has every surfel.
USUAL = Settings(supersampling=2, detail_tolerance=0.7)

SUN = Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0))
WORLD = (0.1, 0.1, 0.1)


@pytest.hookimpl(tryfirst=True)
def pytest_generate_tests(metafunc):
    """Run each test that draws with every method, unless it names its own; new methods are included automatically.

    The method is always the first parameter, so that a case has the same name however the suite is called. The table of
    known failures needs these names.
    """
    if "method" in metafunc.fixturenames and not _names_methods(metafunc.definition):
        metafunc.parametrize("method", METHODS)


def pytest_collection_modifyitems(config, items):
    """Leaves out what methods need not draw. The cases in the table of known failures must fail, by an assertion."""
    reasons = {case: reason for reason, cases in KNOWN_FAILURES.items() for case in cases}
    ours = [item for item in items if "tests/extremes" in item.path.as_posix()]
    ALL_CASES.update(item.name for item in ours)
    for item in ours:
        if item.name in reasons:
            item.add_marker(pytest.mark.xfail(reason=reasons[item.name], strict=True, raises=AssertionError))
    if hypothesis_settings.get_current_profile_name() != "long":
        spared = set(_spared(ours))
        config.hook.pytest_deselected(items=list(spared))
        items[:] = [item for item in items if item not in spared]


def _spared(items):
    """The items of methods that are no default and draw another case of the same test."""
    tests = {}
    for item in items:
        if "method" in item.fixturenames and not _names_methods(item):
            others = tuple((name, repr(v)) for name, v in item.callspec.params.items() if name != "method")
            tests.setdefault((item.path, item.originalname), {}).setdefault(others, []).append(item)
    for cases in tests.values():
        for number, drawn in enumerate(cases.values()):
            is_end = number in (0, len(cases) - 1)
            yield from (i for i in drawn if not is_end and not _is_turn(i.callspec.params["method"], number))


def _is_turn(method: str, number: int) -> bool:
    """Whether a method draws the case of this number."""
    return method in DEFAULTS or (number + list(METHODS).index(method)) % SHARE == 0


def _names_methods(definition) -> bool:
    """Whether a test names the methods that it draws with."""
    return any("method" in mark.args[0] for mark in definition.iter_markers("parametrize"))


@pytest.fixture
def known_failures():
    """The names of the cases that are known to fail."""
    return [case for cases in KNOWN_FAILURES.values() for case in cases]


@pytest.fixture
def all_cases():
    """The names of all collected cases, of those that are left out, too."""
    return ALL_CASES


@pytest.fixture
def defaults():
    """The names of the methods that the presets use."""
    return DEFAULTS


@pytest.fixture(scope="session")
def truths():
    """(test, its parameters without the method, label) -> the truth, which is the same for every method."""
    return {}


def samples(settings: Settings, method: str) -> int:
    """The number of samples along each side of a pixel, for this method."""
    return 1 if method == Settings().method else settings.supersampling


@pytest.fixture
def render_all(on_device, method):
    """render_all([(scene, camera, settings or None)]) -> [Frame], drawn by one renderer with the method under test."""

    def job(device, shots):
        renderer = Renderer(device)
        return [
            renderer.render(
                scene, camera, replace(s or USUAL, method=method, supersampling=samples(s or USUAL, method))
            )
            for scene, camera, s in shots
        ]

    return lambda shots: on_device(lambda device: job(device, shots))


@pytest.fixture
def hold(render_all, method, truths, request):
    """hold({label: (scene, camera[, settings])}, least=dB) asserts the bounds; returns {label: (frame, truth)}.

    may_have_gaps: allow holes.
    """

    others = tuple((name, repr(v)) for name, v in request.node.callspec.params.items() if name != "method")

    def check(shots, least=LEAST_PSNR, may_have_gaps=False):
        shots = {label: (*shot, None)[:3] for label, shot in shots.items()}
        results = {}
        for (label, (scene, camera, settings)), frame in zip(shots.items(), render_all(shots.values()), strict=True):
            settings = settings or USUAL
            key = request.node.originalname, others, label
            if key not in truths:
                truths[key] = render_exact(scene, camera, settings, samples=settings.supersampling)
            truth = truths[key]
            assert_finite(frame, label)
            holes = np.count_nonzero((truth.coverage > 0.999) & (frame.coverage == 0))
            assert holes == 0 or may_have_gaps, f"{label}: {holes} empty pixels where the truth is covered"
            if method in UNFILTERED:
                found = psnr(frame.color, truth.color)
                assert found >= least, f"{label}: {found:.1f} dB against the truth"
            results[label] = frame, truth
        return results

    return check


def assert_finite(frame, label):
    """The frame's four arrays contain no NaN or infinite number."""
    for name in ("color", "depth", "normal", "coverage"):
        bad = np.count_nonzero(~np.isfinite(getattr(frame, name)))
        assert bad == 0, f"{label}: {bad} non-finite numbers in {name}"


@pytest.fixture
def is_unfiltered(method):
    """Whether the method's picture is by definition the truth's for the same samples."""
    return method in UNFILTERED


@pytest.fixture
def is_default(method):
    """Whether a preset uses the method."""
    return method in DEFAULTS


@pytest.fixture
def lit():
    """lit(*surfels or instances) -> a scene of them under a sun and a uniform world."""
    return lambda *surfels: Scene(surfels, (SUN,), WORLD)


@pytest.fixture
def camera():
    """camera(fov=60, size=(32, 32), near=0.01, far=1000, shift=(0, 0)) -> a camera at the origin that looks down -Z."""

    def build(fov=60.0, size=(32, 32), near=0.01, far=1000.0, shift=(0.0, 0.0)):
        return Camera.perspective(np.eye(4), np.radians(fov), size, near, far, shift)

    return build
