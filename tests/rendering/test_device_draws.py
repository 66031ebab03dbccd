# SPDX-License-Identifier: GPL-3.0-or-later
"""What a device promises of its textures, targets, pipelines and draws, on pixels that are known exactly.

Every device has these tests in its own program; so most pictures need to be drawn on one device only.
"""

from dataclasses import replace

import numpy as np
import pytest

from splat_addon.rendering.device.interface import FORMATS, PipelineDescription
from splat_addon.rendering.plan.composition import compose

#: One triangle over the whole of a viewport.
OVER_ALL = compose("fullscreen.vert")
#: Triangle t covers the whole of column t, of 16 columns.
COLUMNS = """
void main() {
  int corner = gl_VertexID % 3;
  number = float(gl_VertexID / 3);
  gl_Position = vec4(number / 8.0 - 1.0 + (corner == 1 ? 0.25 : 0.0), corner == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
"""
#: The part of a column's triangle that its pixel in row 0 lies in.
ROW = np.s_[0]

VALUE = (("Value", "value", (("vec4", "color"), ("float", "depth"))),)
FILL = PipelineDescription(
    "fill", OVER_ALL, "void main() { color = value.color; }", VALUE, outputs=(("vec4", "color"),)
)
AT_DEPTH = replace(
    FILL,
    name="at_depth",
    vertex="void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, value.depth, 1.0); }",
    depth_test=True,
    depth_write=True,
)
NUMBERED = PipelineDescription(
    "numbered",
    COLUMNS,
    "void main() { color = vec4(number + 1.0, 0.0, 0.0, 0.0); }",
    varyings=(("flat", "float", "number"),),
    outputs=(("vec4", "color"),),
)


def value(*color, depth=0.0) -> np.ndarray:
    """The block of `FILL`; its colour has this first channel, or these channels."""
    return np.array([*color, *(0,) * (4 - len(color)), depth, 0, 0, 0], np.float32)


def pixels(device, target, slot=0) -> np.ndarray:
    """What was drawn."""
    found = target.read(slot)
    device.restore()
    return found


@pytest.mark.parametrize("format", [name for name in FORMATS if name != "DEPTH32F"])
def test_what_is_put_into_a_texture_is_read_from_it(format, on_device):
    """The width is odd, so that rows whose length drivers round up are seen. Numbers are rounded to the nearest of
    65,535 steps."""
    data = np.linspace(0, 1, 5 * 3 * FORMATS[format], dtype=np.float32).reshape(3, 5, -1)
    found = on_device(lambda device: device.target([device.texture((5, 3), format, data)]).read(0))
    atol = {"RGBA16F": 2**-11, "RGBA16": 0.51 / 65535}.get(format, 0)
    np.testing.assert_allclose(found, data, rtol=0, atol=atol)


def test_rows_replace_those_of_a_texture(on_device):
    before, rows = np.zeros((4, 3, 4), np.float32), np.arange(24, dtype=np.float32).reshape(2, 3, 4) + 1

    def draw(device):
        texture = device.texture((3, 4), "RGBA32F", before)
        device.write(texture, 1, rows)
        return pixels(device, device.target([texture]))

    np.testing.assert_array_equal(on_device(draw), np.concatenate([before[:1], rows, before[:1]]))


@pytest.mark.parametrize(("first", "count"), [(0, 1), (0, 16), (3, 5), (15, 1), (4, 0)])
def test_triangles_are_drawn_from_any_number_on(first, count, on_device):
    def draw(device):
        target = device.target([device.texture((16, 1), "R32F")])
        target.clear(color=0.0)
        device.draw_triangles(device.pipeline(NUMBERED), target, count, [], [], first=first)
        return pixels(device, target)

    numbers = np.arange(16)
    expected = np.where((numbers >= first) & (numbers < first + count), numbers + 1, 0)
    np.testing.assert_array_equal(on_device(draw)[ROW, :, 0], expected)


def test_any_number_of_triangles_is_drawn_after_few(on_device):
    """Triangle t covers the pixel t % 16 and adds one."""
    adding = replace(
        NUMBERED,
        name="adding",
        vertex=COLUMNS.replace("number / 8.0", "mod(number, 16.0) / 8.0"),
        fragment="void main() { color = vec4(1.0); }",
        blend="add",
    )

    def draw(device):
        target = device.target([device.texture((16, 1), "R32F")])
        target.clear(color=0.0)
        for count in (16, 16 * 300):
            device.draw_triangles(device.pipeline(adding), target, count, [], [])
        return pixels(device, target)

    np.testing.assert_array_equal(on_device(draw)[ROW, :, 0], np.full(16, 301))


def test_a_viewport_bounds_what_is_drawn(on_device):
    def draw(device):
        target = device.target([device.texture((5, 4), "RGBA32F")])
        target.clear(color=(1, 2, 3, 4))
        device.draw_fullscreen(device.pipeline(FILL), target, [value(9)], [], (1, 2, 3, 1))
        return pixels(device, target)

    expected = np.tile((1.0, 2, 3, 4), (4, 5, 1))
    expected[2, 1:4] = 9, 0, 0, 0
    np.testing.assert_array_equal(on_device(draw), expected)


@pytest.mark.parametrize(("blend", "expected"), [("none", 50), ("add", sum(range(51)))])
@pytest.mark.parametrize("format", ["R32F", "RGBA32F", "RGBA16F"])
def test_each_draw_has_its_own_values_and_replaces_or_adds(blend, expected, format, on_device):
    """The values are arrays that nobody else keeps."""

    def draw(device):
        target = device.target([device.texture((2, 2), format)])
        target.clear(color=0.0)
        pipeline = device.pipeline(replace(FILL, name=f"fill_{blend}", blend=blend))
        for number in range(1, 51):
            device.draw_fullscreen(pipeline, target, [value(number)], [])
        return pixels(device, target)

    np.testing.assert_array_equal(on_device(draw)[..., 0], np.full((2, 2), expected))


def test_depth_passes_what_is_not_farther_and_is_written_only_where_asked(on_device):
    steps = ((0.5, True, 1), (0.7, True, 2), (0.5, True, 3), (0.2, False, 4), (0.4, True, 5), (0.45, True, 6))

    def draw(device):
        target = device.target([device.texture((1, 1), "R32F")], device.texture((1, 1), "DEPTH32F"))
        target.clear(color=0.0, depth=1.0)
        seen = []
        for depth, writes, number in steps:
            pipeline = device.pipeline(replace(AT_DEPTH, name=f"depth_{writes}", depth_write=writes))
            device.draw_fullscreen(pipeline, target, [value(number, depth=2 * depth - 1)], [])
            seen.append(pixels(device, target).item())
        return seen

    assert on_device(draw) == [1, 1, 3, 4, 5, 5]


def test_a_shader_may_set_the_depth_in_32_bits(on_device):
    """The second value is nearer by less than a depth of 24 bits resolves."""
    described = replace(
        AT_DEPTH,
        name="own_depth",
        vertex=OVER_ALL,
        fragment="void main() { color = value.color; gl_FragDepth = value.depth; }",
        fragment_depth=True,
    )

    def draw(device):
        target = device.target([device.texture((1, 1), "R32F")], device.texture((1, 1), "DEPTH32F"))
        target.clear(color=0.0, depth=1.0)
        for number, depth in enumerate((1e-4, 1e-4 - 1e-10, 1e-4), 1):
            device.draw_fullscreen(device.pipeline(described), target, [value(number, depth=depth)], [])
        return pixels(device, target).item()

    assert on_device(draw) == 2


def test_colour_and_depth_are_cleared_apart_whatever_was_drawn_before(on_device):
    def draw(device):
        target = device.target([device.texture((1, 1), "R32F")], device.texture((1, 1), "DEPTH32F"))
        near, far, unwritten = (value(n, depth=d) for n, d in ((1, -0.5), (2, 0.5), (3, -0.9)))
        drawn, seen = device.pipeline(AT_DEPTH), []

        def look(block, description=AT_DEPTH):
            device.draw_fullscreen(device.pipeline(description), target, [block], [])
            seen.append(target.read(0).item())

        target.clear(color=0.0, depth=1.0)
        device.draw_fullscreen(drawn, target, [near], [])
        target.clear(color=7.0)
        look(far)
        look(unwritten, replace(AT_DEPTH, name="unwritten", depth_write=False))
        target.clear(depth=1.0)
        seen.append(target.read(0).item())
        look(far)
        device.restore()
        return seen

    assert on_device(draw) == [7, 3, 3, 2]


def test_depths_can_be_drawn_alone_and_read_by_a_shader(on_device):
    alone = replace(AT_DEPTH, name="alone", fragment="void main() {}", outputs=())
    reading = PipelineDescription(
        "reading",
        OVER_ALL,
        "void main() { color = texelFetch(depths, ivec2(gl_FragCoord.xy), 0); }",
        samplers=("depths",),
        outputs=(("vec4", "color"),),
    )

    def draw(device):
        depths = device.texture((2, 1), "DEPTH32F")
        only, target = device.target([], depths), device.target([device.texture((2, 1), "R32F")])
        only.clear(depth=1.0)
        device.draw_fullscreen(device.pipeline(alone), only, [value(0, depth=-0.5)], [], (1, 0, 1, 1))
        device.finish(only)
        device.draw_fullscreen(device.pipeline(reading), target, [], [depths])
        return pixels(device, target)

    np.testing.assert_array_equal(on_device(draw)[0, :, 0], (1, 0.25))


def test_blocks_samplers_outputs_varyings_and_constants_reach_the_shader_by_their_names(on_device):
    """Every slot has another value, and the textures have other formats."""
    described = PipelineDescription(
        "all_slots",
        "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);"
        " across = gl_Position.xy; fixed_number = float(gl_VertexID) * 0.0 + COUNT; }",
        """void main() {
          first = value.color + texelFetch(ones, ivec2(0), 0) + vec4(across, fixed_number, 0.0);
          second = (turn.matrix * vec4(1.0, 2.0, 3.0, 4.0)).xy + texelFetch(pairs, ivec2(1, 0), 0).xy;
        }""",
        (*VALUE, ("Turn", "turn", (("mat4", "matrix"),))),
        ("ones", "pairs"),
        (("smooth", "vec2", "across"), ("flat", "float", "fixed_number")),
        (("vec4", "first"), ("vec2", "second")),
        (("COUNT", "5.0"),),
    )
    matrix = np.arange(16, dtype=np.float32).reshape(4, 4)

    def draw(device):
        ones = device.texture((1, 1), "R32F", np.ones((1, 1, 1), np.float32))
        pairs = device.texture((2, 1), "RG32F", np.array([[[0, 0], [100, 200]]], np.float32))
        target = device.target([device.texture((2, 2), "RGBA32F"), device.texture((2, 2), "RG32F")])
        blocks = [value(10, 20, 30, 40), matrix.T.ravel()]
        device.draw_fullscreen(device.pipeline(described), target, blocks, [ones, pairs])
        return target.read(0), pixels(device, target, 1)

    first, second = on_device(draw)
    across = np.stack(np.meshgrid((-0.5, 0.5), (-0.5, 0.5)), axis=-1)
    np.testing.assert_allclose(first[..., :2], np.add((11, 20), across), rtol=1e-6)
    np.testing.assert_array_equal(first[..., 2:], np.full((2, 2, 2), (35, 41)))
    np.testing.assert_array_equal(second, np.full((2, 2, 2), np.add((100, 200), (matrix @ (1, 2, 3, 4))[:2])))


def test_a_shader_that_does_not_compile_is_named(on_device):
    with pytest.raises(RuntimeError, match="The shader of pipeline broken does not compile"):
        on_device(lambda device: device.pipeline(replace(FILL, name="broken", fragment="void main() { color = 1; }}")))


def test_a_texture_wider_than_the_device_holds_is_refused(on_device):
    with pytest.raises(ValueError, match="does not fit on this graphics device"):
        on_device(lambda device: device.texture((1 << 20, 1), "R32F"))
