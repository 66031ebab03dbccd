# SPDX-License-Identifier: GPL-3.0-or-later
"""Fixtures for both devices: `--device standalone` (plain Python, moderngl) or `--device blender` (inside Blender).

The devices cannot share a process, so scripts/test.py runs pytest once for each.
"""

import io
import os
import re
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

ROOT = Path(__file__).resolve().parent.parent
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

# Mesa's software rasterizer compiles a program for each combination of features, which takes far longer than to draw a
# small picture with it. Without optimization and with half as wide registers it takes a third of that time.
os.environ.setdefault("GALLIVM_PERF", "nopt")
os.environ.setdefault("LP_NATIVE_VECTOR_WIDTH", "128")

from splat_addon import reference  # noqa: E402
from splat_addon.reference.kept import folder, remembered, write  # noqa: E402

pytest_plugins = ("tests.collecting", "tests.costs")

# Properties are tried with the same few examples in every run; `--hypothesis-profile long` tries many new ones. A test
# whose examples are dear takes a share: @settings(max_examples=settings.default.max_examples // 5).
settings.register_profile("every run", deadline=None, max_examples=50, derandomize=True, database=None)
settings.register_profile("long", deadline=None, max_examples=2000)
settings.load_profile("every run")

# The truth does not depend on the device, so the group of tests that comes first finds it for both. Tests import these
# two by name, and all of them after this file.
reference.render_exact, reference.render_ewa = map(remembered, (reference.render_exact, reference.render_ewa))


def pytest_addoption(parser):
    parser.addoption("--device", choices=("standalone", "blender"), default="standalone")


@pytest.fixture(scope="session")
def models():
    """The folder of real meshes beside the checkout; a test that needs one is skipped where it is missing."""
    folder = ROOT.parent / "shared" / "models"
    if not folder.is_dir():
        pytest.skip("the folder of test models, ../shared/models, is not here")
    return folder


@pytest.fixture
def on_both_devices(request):
    """on_both_devices(draw, hold) calls hold(here, standalone) to compare the arrays of this device with the
    standalone one's.

    draw() returns arrays by name. The standalone device draws them once and keeps them for the other devices, under the
    name of the test with its parameters, so that no two pictures share a file.
    """
    kept = folder("pictures", "splat_addon/**/*.py", "shaders/**/*.glsl", "tests/**/*.py")
    file = kept / (re.sub(r"[^\w.]+", "-", request.node.nodeid) + ".npz")

    def compare(draw, hold):
        if request.config.getoption("--device") == "blender":
            assert file.exists(), f"{file} is missing: run these tests with --device standalone first"
            with np.load(file) as standalone:
                hold(draw(), dict(standalone))
        elif not file.exists():
            contents = io.BytesIO()
            np.savez(contents, **draw())
            write(file, contents.getvalue())

    return compare


@pytest.fixture(scope="session")
def on_device(request):
    """on_device(job) calls job(device) where that device can draw; returns or raises what the job does."""
    if request.config.getoption("--device") == "blender":
        yield _on_blenders_device()
    else:
        from splat_addon.rendering import open_device

        device = open_device("standalone")
        yield lambda job: job(device)


@pytest.fixture
def render(on_device):
    """render(scene, camera, settings) -> Frame, on the device under test."""
    from splat_addon.rendering import Renderer

    return lambda *arguments, **options: on_device(lambda device: Renderer(device).render(*arguments, **options))


def _on_blenders_device():
    """From Blender 5.2 on a graphics context can be created at any time; before, only inside an engine's render()."""
    import bpy  # noqa: F401  in a wheel, `gpu` is there after it
    import gpu

    from splat_addon.rendering import open_device

    if not hasattr(gpu, "init"):
        return _inside_a_blender_render
    gpu.init()
    device = open_device("blender")
    return lambda job: job(device)


def _inside_a_blender_render(job):
    import bpy

    from splat_addon.rendering import open_device

    outcome = {}

    class JobEngine(bpy.types.RenderEngine):
        bl_idname, bl_label, bl_use_gpu_context = "TEST_JOB", "Test job", True

        def render(self, depsgraph):
            try:
                outcome["result"] = job(open_device("blender"))
            except BaseException as error:
                outcome["error"] = error

    scene = bpy.data.scenes.new("job")
    scene.camera = bpy.data.objects.new("job", bpy.data.cameras.new("job"))
    scene.render.resolution_x = scene.render.resolution_y = 4
    bpy.utils.register_class(JobEngine)
    try:
        scene.render.engine = "TEST_JOB"
        bpy.ops.render.render(scene=scene.name)
    finally:
        scene.render.engine = "BLENDER_WORKBENCH"
        bpy.utils.unregister_class(JobEngine)
        bpy.data.scenes.remove(scene)
    if "error" in outcome:
        raise outcome["error"]
    return outcome["result"]


def pytest_sessionfinish(session, exitstatus):
    session.config.exit_code = int(exitstatus)


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    """Leave the process right after the summary, because Blender 4.5 may hang and 5.0 crash while the
    interpreter ends.
    """
    if "bpy" in sys.modules:
        sys.stdout.flush()
        sys.stderr.flush()
        os._exit(getattr(config, "exit_code", 1))
