# SPDX-License-Identifier: GPL-3.0-or-later
"""Every fact here is held for every registered method, against the float64 truth with the same samples.

Hard bounds for all: no non-finite number, and no empty pixel where the truth is covered whole. Methods without a
prefilter must also be the truth's picture within `LEAST_PSNR`. Where a paper's own formula fails, the case stands in
`KNOWN_FAILURES`; what users get without asking has none there.
"""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.reference import render_exact
from splat_addon.reference.metrics import psnr
from splat_addon.rendering import Camera, Light, Renderer, Scene, Settings
from splat_addon.rendering.methods import METHODS

#: Methods whose picture is by definition the truth's with the same samples; the others filter.
UNFILTERED = ("quad",)

#: What users get without asking: these may not fail.
DEFAULTS = ("mip", "quad")


def _cases(test: str, method: str, *ids) -> tuple[str, ...]:
    """Names of a test's cases, as pytest prints them."""
    return tuple(f"{test}[{method}-{i}]" for i in ids)


_GRAZING, _FLOOR = "test_a_grazing_sheet_is_the_true_one", "test_a_sheet_that_reaches_past_the_viewer_has_no_holes"
_GIANT, _WINDOW = "test_a_giant_floor_reaches_to_its_horizon", "test_a_window_far_off_the_axis_is_the_true_one"
_POSES = "test_the_eye_in_the_surface_sees_no_hole"

#: why -> the cases that fail for it, each with its method. Strict: one that passes must leave the table.
KNOWN_FAILURES = {
    "Botsch and Kobbelt 2003 project in parallel: off the axis a tilted disc is too small, and gaps open": (
        *_cases(_GRAZING, "affine", 60, 61, 62, 64, 65, 67, 68, 71, 72, 78, 79),
        *_cases(_FLOOR, "affine", 0.3, 0.1),
        *_cases(_GIANT, "affine", "1.0-floor", "1.0-both"),
        *_cases(_WINDOW, "affine", 2, 5, 20, 100),
        *_cases("test_any_epsilon_gives_its_true_picture", "affine", "0-40", "1e-07-40", "0.0001-45", "0.01-60"),
        f"{_POSES}[affine]",
        *_cases("test_no_splat_hides_itself", "affine", "60-0", "60-1e-07", "60-1e-06", "85-0", "85-1e-07", "85-1e-06"),
        *_cases("test_no_splat_hides_itself_in_linear_depth", "affine", 60, 85),
    ),
    "Zwicker et al. 2001 take a splat's projection as affine: a near or far off one is cut short": (
        *_cases(_GIANT, "ewa", "1.0-floor", "1.0-both"),
        *_cases("test_a_long_picture_is_the_true_one", "ewa", "8192x16"),
        f"{_POSES}[ewa]",
    ),
    "a filter in the picture keeps an edge-on splat a pixel wide": (
        *(f"test_edge_on_nothing_is_drawn[{method}]" for method in ("ewa", "raycast", "homogeneous", "affine")),
    ),
}

#: Kept to compare with, and known to fail at many extremes; what holds of them is in tests/rendering/methods.
COMPARED_ONLY = ("homogeneous_printed", "affine_unfiltered")

#: dB; measured: 70 and more (docs/numerics.md). Of 64 x 64 pixels one sample that falls the other way costs 60 dB.
LEAST_PSNR = 50

#: Of the truth, and of every method but the default, which needs one sample.
USUAL = Settings(supersampling=2)

SUN = Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0))
WORLD = (0.1, 0.1, 0.1)


def pytest_generate_tests(metafunc):
    """Every test that draws, for every method but where it names its own; a new method joins by itself."""
    named = any("method" in mark.args[0] for mark in metafunc.definition.iter_markers("parametrize"))
    if "method" in metafunc.fixturenames and not named:
        metafunc.parametrize("method", [method for method in METHODS if method not in COMPARED_ONLY])


def pytest_collection_modifyitems(items):
    """What the table names must fail, and by an assertion."""
    reasons = {case: reason for reason, cases in KNOWN_FAILURES.items() for case in cases}
    for item in items:
        if item.name in reasons and "tests/extremes" in item.path.as_posix():
            item.add_marker(pytest.mark.xfail(reason=reasons[item.name], strict=True, raises=AssertionError))


@pytest.fixture
def known_failures():
    """Names of the cases that are known to fail."""
    return [case for cases in KNOWN_FAILURES.values() for case in cases]


@pytest.fixture
def defaults():
    """Names of the methods that users get without asking."""
    return DEFAULTS


@pytest.fixture(scope="session")
def truths():
    """(test, its parameters but the method, label) -> the truth, which no method changes."""
    return {}


def samples(settings: Settings, method: str) -> int:
    """Along each side of a pixel, for this method."""
    return 1 if method == Settings().method else settings.supersampling


@pytest.fixture
def render_all(on_device, method):
    """render_all([(scene, camera, settings or None)]) -> [Frame], by one renderer and with the method under test."""

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
    """hold({label: (scene, camera[, settings])}, least=dB) asserts the bounds; returns {label: (frame, truth)}."""

    others = tuple((name, repr(v)) for name, v in request.node.callspec.params.items() if name != "method")

    def check(shots, least=LEAST_PSNR):
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
            assert holes == 0, f"{label}: {holes} empty pixels where the truth is covered"
            if method in UNFILTERED:
                found = psnr(frame.color, truth.color)
                assert found >= least, f"{label}: {found:.1f} dB against the truth"
            results[label] = frame, truth
        return results

    return check


def assert_finite(frame, label):
    """Not one NaN or infinite number in the four arrays."""
    for name in ("color", "depth", "normal", "coverage"):
        bad = np.count_nonzero(~np.isfinite(getattr(frame, name)))
        assert bad == 0, f"{label}: {bad} non-finite numbers in {name}"


@pytest.fixture
def is_unfiltered(method):
    """Whether the method's picture is by definition the truth's with the same samples."""
    return method in UNFILTERED


@pytest.fixture
def is_default(method):
    """Whether the method is one that users get without asking for it."""
    return method in DEFAULTS


@pytest.fixture
def lit():
    """lit(*surfels or instances): a scene of them under a sun and an even world."""
    return lambda *surfels: Scene(surfels, (SUN,), WORLD)


@pytest.fixture
def camera():
    """camera(fov=60, size=(64, 64), near=0.01, far=1000, shift=(0, 0)): at the origin, looking down -Z."""

    def build(fov=60.0, size=(64, 64), near=0.01, far=1000.0, shift=(0.0, 0.0)):
        return Camera.perspective(np.eye(4), np.radians(fov), size, near, far, shift)

    return build
