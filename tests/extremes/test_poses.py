# SPDX-License-Identifier: GPL-3.0-or-later
"""A camera outside, inside or in the surface, perspective or parallel, sees no holes and no NaN."""

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from splat_addon.reference import scenes
from splat_addon.rendering import Camera, look_at

SIZE = (40, 40)
EXAMPLES = 10


def vectors(low, high):
    return st.tuples(*[st.floats(low, high)] * 3)


def powers(low, high):
    return st.floats(low, high).map(lambda exponent: 10.0**exponent)


#: A direction, and another one that is not parallel to it.
DIRECTIONS = st.tuples(vectors(-1, 1), vectors(-1, 1)).filter(lambda d: np.linalg.norm(np.cross(*d)) > 1e-3)


@st.composite
def outside(draw):
    eye, (direction, up) = draw(vectors(-3, 3)), draw(DIRECTIONS)
    matrix = look_at(eye, np.add(np.multiply(direction, 0.3), -np.sign(eye[0]) * 1e-3), up)
    return Camera.perspective(matrix, np.radians(draw(st.floats(5, 140))), SIZE, 0.01, 100)


@st.composite
def in_the_tube(draw):
    """A place in the tube of the outer torus, on its surface or just in front of it."""
    along, around = draw(st.floats(0, 6.28)), draw(st.floats(0, 6.28))
    ring = np.array((np.cos(along), np.sin(along), 0))
    return ring + draw(st.floats(0, 0.5)) * (np.cos(around) * ring + np.sin(around) * np.array((0, 0, 1)))


@st.composite
def through_the_surface(draw):
    """Cameras in the tube, with near planes from far below a splat's size."""
    eye, (direction, up) = draw(in_the_tube()), draw(DIRECTIONS)
    near = draw(powers(-4, -1))
    return Camera.perspective(look_at(eye, eye + direction, up), np.radians(draw(st.floats(20, 150))), SIZE, near, 100)


@st.composite
def parallel(draw):
    """A parallel camera that looks at a place in the tube; its near plane is before it, or behind it as in a
    viewport.
    """
    target, (direction, up) = draw(in_the_tube()), draw(DIRECTIONS)
    near, far = draw(st.sampled_from(((-5, 5), (0.01, 20))))
    return Camera.orthographic(
        look_at(np.subtract(target, direction), target, up), draw(powers(-1.5, 1)), SIZE, near, far
    )


POSES = {"outside": outside(), "through the surface": through_the_surface(), "parallel": parallel()}


#: Their papers' formulas leave gaps before large splats near the eye, which fixed poses hold (`KNOWN_FAILURES`): which
#: random pose finds one is not known. `ewa`: the affine map (Zwicker et al. 2001, equation 9). `raycast_printed`: the
#: square of 2 r / z about the centre (Botsch et al. 2005, section 3), too small off the axis. Sprites: equation 1 of
#: Botsch and Kobbelt 2003, the size on the axis.
WITH_GAPS = ("ewa", "raycast_printed", "sprites", "sprites_printed", "sprites_unfiltered")


def test_the_eye_in_the_surface_sees_no_hole(hold):
    """The camera is in the wall of the outer torus, looks along it, and has splats all around."""
    matrix = look_at((0.706, 0.642, -0.273), (1.326, -0.142, -0.257), (0.667, 0.517, -0.537))
    camera = Camera.perspective(matrix, np.radians(50), SIZE, 4e-4, 100)
    hold({"in the wall": (scenes.torus(2500, SIZE)[0], camera)}, least=40)


@pytest.mark.parametrize("kind", POSES)
def test_no_pose_leaves_a_hole(kind, hold, method):
    scene, _ = scenes.torus(2500, SIZE)
    covered = []

    @settings(
        max_examples=EXAMPLES, derandomize=True, deadline=None, database=None, phases=[Phase.generate],
        report_multiple_bugs=False,
    )  # fmt: skip
    @given(camera=POSES[kind])
    def check(camera):
        label = f"{camera.matrix_world.tolist()}, window {camera.window}, near {camera.near}"
        ((_, truth),) = hold({label: (scene, camera)}, 40, method in WITH_GAPS).values()
        covered.append(truth.coverage.any())

    check()
    assert sum(covered) > EXAMPLES / 3
