# SPDX-License-Identifier: GPL-3.0-or-later
"""Every fact here is held for every registered method, against the float64 truth with the same samples.

Hard bounds for all: no non-finite number, and no empty pixel where the truth is covered whole. Methods without a
prefilter must also be the truth's picture within `LEAST_PSNR`.
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

#: What users get without asking, and the plain one: held to every fact. The papers' methods are held where their
#: arithmetic differs.
ALWAYS = ("mip", "quad")
EVERY_METHOD = ("test_scale", "test_offset", "test_grazing", "test_normals", "test_weak_weights")

#: (method, test): why it fails there, in the paper's own formula or for now.
KNOWN_FAILURES = {
    ("affine", "test_a_grazing_sheet_is_the_true_one"): "the foreshortening bound leaves holes at flat angles",
    ("affine", "test_a_sheet_that_reaches_past_the_viewer_has_no_holes"): "sprites are cut at flat angles",
    **{
        (name, "test_edge_on_nothing_is_drawn"): "a screen-space filter keeps an edge-on splat a pixel wide"
        for name in ("ewa", "raycast", "homogeneous", "affine")
    },
    ("ewa", "test_a_scaled_world_looks_the_same"): "tiny weights magnify rounding of normals to 2e-3 at silhouettes",
    ("mip", "test_any_epsilon_gives_its_true_picture"): "at 100 radii pixels stay empty",
    ("mip", "test_any_size_is_the_true_picture"): "pixels wider than high leave holes",
}

#: dB; measured: 70 and more (docs/numerics.md). Of 64 x 64 pixels one sample that falls the other way costs 60 dB.
LEAST_PSNR = 50

SUN = Light("sun", energy=2.0, direction=(0.3, 0.2, -1.0))
WORLD = (0.1, 0.1, 0.1)


def pytest_generate_tests(metafunc):
    """Every test that draws, for every method that its file asks for; a new method joins by itself."""
    if "method" in metafunc.fixturenames:
        methods = METHODS if metafunc.module.__name__.split(".")[-1] in EVERY_METHOD else ALWAYS
        metafunc.parametrize("method", methods)


@pytest.fixture(autouse=True)
def known_failures(request):
    """A method may fail where the table says so."""
    parameters = getattr(request.node, "callspec", None)
    reason = parameters and KNOWN_FAILURES.get((parameters.params.get("method"), request.node.originalname))
    if reason:
        request.applymarker(pytest.mark.xfail(reason=reason, strict=False))


@pytest.fixture
def render_all(on_device, method):
    """render_all([(scene, camera, settings or None)]) -> [Frame], by one renderer and with the method under test."""

    def job(device, shots):
        renderer = Renderer(device)
        return [renderer.render(scene, camera, replace(s or Settings(), method=method)) for scene, camera, s in shots]

    return lambda shots: on_device(lambda device: job(device, shots))


@pytest.fixture
def hold(render_all, method):
    """hold({label: (scene, camera[, settings])}, least=dB) asserts the bounds; returns {label: (frame, truth)}."""

    def check(shots, least=LEAST_PSNR):
        shots = {label: (*shot, None)[:3] for label, shot in shots.items()}
        results = {}
        for (label, (scene, camera, settings)), frame in zip(shots.items(), render_all(shots.values()), strict=True):
            settings = settings or Settings()
            truth = render_exact(scene, camera, settings, samples=settings.supersampling)
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
def lit():
    """lit(*surfels or instances): a scene of them under a sun and an even world."""
    return lambda *surfels: Scene(surfels, (SUN,), WORLD)


@pytest.fixture
def camera():
    """camera(fov=60, size=(64, 64), near=0.01, far=1000, shift=(0, 0)): at the origin, looking down -Z."""

    def build(fov=60.0, size=(64, 64), near=0.01, far=1000.0, shift=(0.0, 0.0)):
        return Camera.perspective(np.eye(4), np.radians(fov), size, near, far, shift)

    return build
