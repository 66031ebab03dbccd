# SPDX-License-Identifier: GPL-3.0-or-later
"""What rasterising small splats in a compute shader would save: a trial beside the passes that draw triangles.

The splats are those that a cut of one model draws, most of them below two pixels. One compute pass finds the nearest
depth by atomicMin, another adds weighted attributes in fixed point by atomicAdd. They do less than the engine's passes:
no clip lines, no silhouettes, no textures, and a kernel that is affine in the picture. *vertices* is the share of a
bare pass of triangles that is left if nothing of it is rasterised: it draws the same triangles into one pixel. Times
are those of a graphics card's timer queries; with software OpenGL, whose queries leave vertices out, the clock's.
"""

from __future__ import annotations

from functools import partial
from time import perf_counter

import moderngl
import numpy as np

from measuring.models import in_view, load
from measuring.timer_queries import has_timer_queries, timed_draws
from measuring.timing import in_turn
from splat_addon.hierarchy import cut_blocks, entries_of
from splat_addon.quaternions import axes_columns
from splat_addon.rendering import Renderer, Settings, open_device
from splat_addon.rendering.detail.hierarchies import hierarchy_of
from splat_addon.rendering.detail.levels import sight
from splat_addon.rendering.device import Device
from splat_addon.sampling import PLAIN, sample_mesh

DEVICES = ("standalone",)
QUICK = {"size": 64, "resolution": 300, "model": "bunny.obj.gz"}
PASSES = "visibility", "attributes"
COLUMNS = (
    "surfels",
    "drawn",
    *(f"{name}, {what}" for name in PASSES for what in ("ms", "compute/triangles")),
    "vertices",
)
FIELD_OF_VIEW = 0.66
GROUP = 64

SPLATS = """#version 430
layout(std430, binding = 0) readonly buffer Splats { vec4 splats[]; };
uniform mat4 view;
uniform float focal;
"""
COMPUTE = f"""{SPLATS}
layout(local_size_x = {GROUP}) in;
layout(r32ui, binding = 0) uniform uimage2D depth;
uniform int count, size;

struct Splat {{ vec3 eye, u, v, normal; vec2 middle; mat2 axes; }};

Splat splat(int i) {{
  Splat s;
  vec4 a = splats[4 * i], b = splats[4 * i + 1], c = splats[4 * i + 2];
  mat3 turn = mat3(view);
  s.eye = (view * vec4(a.xyz, 1.0)).xyz;
  s.u = turn * b.xyz;
  s.v = turn * c.xyz;
  s.normal = turn * vec3(a.w, b.w, c.w);
  float scale = focal * 0.5 * float(size) / -s.eye.z;
  s.middle = s.eye.xy * scale + 0.5 * float(size);
  s.axes = scale * mat2(s.u.xy - s.eye.xy * s.u.z / s.eye.z, s.v.xy - s.eye.xy * s.v.z / s.eye.z);
  return s;
}}

void visit(int i, Splat s, ivec2 pixel, vec2 off);

void main() {{
  int i = int(gl_GlobalInvocationID.x);
  if (i >= count) return;
  Splat s = splat(i);
  vec2 reach = REACH;
  ivec2 low = max(ivec2(ceil(s.middle - reach - 0.5)), 0), high = min(ivec2(floor(s.middle + reach - 0.5)), size - 1);
  for (int y = low.y; y <= high.y; y++) {{
    for (int x = low.x; x <= high.x; x++) visit(i, s, ivec2(x, y), vec2(x, y) + 0.5 - s.middle);
  }}
}}
"""
VISIBILITY = """
void visit(int i, Splat s, ivec2 pixel, vec2 off) {
  vec2 q = inverse(s.axes) * off;
  if (dot(q, q) > 1.0) return;
  float far = -s.eye.z - q.x * s.u.z - q.y * s.v.z + 0.3 * length(s.u);
  imageAtomicMin(depth, pixel, floatBitsToUint(far));
}
"""
ATTRIBUTES = """
layout(std430, binding = 1) buffer Sums { int sums[]; };

void visit(int i, Splat s, ivec2 pixel, vec2 off) {
  mat2 covariance = 0.25 * s.axes * transpose(s.axes) + mat2(0.5);
  float square = dot(off, inverse(covariance) * off);
  vec2 q = inverse(s.axes) * off;
  float far = -s.eye.z - q.x * s.u.z - q.y * s.v.z;
  if (square > 4.0 || far > uintBitsToFloat(imageLoad(depth, pixel).r)) return;
  float weight = 65536.0 * exp(-0.5 * square), values[8];
  vec4 color = splats[4 * i + 3];
  values = float[](1.0, color.r, color.g, color.b, s.normal.x, s.normal.y, s.normal.z, far);
  for (int k = 0; k < 8; k++) atomicAdd(sums[8 * (pixel.y * size + pixel.x) + k], int(weight * values[k]));
}
"""
REACH = {
    VISIBILITY: "sqrt(s.axes[0] * s.axes[0] + s.axes[1] * s.axes[1])",
    ATTRIBUTES: "sqrt(s.axes[0] * s.axes[0] + s.axes[1] * s.axes[1] + 2.0)",
}
TRIANGLES = f"""{SPLATS}
out vec2 place;

void main() {{
  int i = gl_VertexID / 3, corner = gl_VertexID % 3;
  place = corner == 0 ? vec2(0.0, 2.0) : vec2(corner == 1 ? -1.73205081 : 1.73205081, -1.0);
  vec3 at = splats[4 * i].xyz + mat2x3(splats[4 * i + 1].xyz, splats[4 * i + 2].xyz) * place;
  vec3 eye = (view * vec4(at, 1.0)).xyz;
  gl_Position = vec4(eye.xy * focal, 0.0, -eye.z);
}}
"""
DISC = "#version 430\nin vec2 place;\nvoid main() { if (dot(place, place) > 1.0) discard; }"


def arguments(parser) -> None:
    parser.add_argument("--size", type=int, default=512, help="pixels along each side")
    parser.add_argument("--model", default="dragon_vrip.ply.gz")
    parser.add_argument("--resolution", type=int, default=2030)


def run(options, report) -> None:
    device = open_device(options.device)
    report.header(device, f"{options.model}, {options.size} x {options.size} pixels, medians of {options.turns} turns")
    surfels = sample_mesh(load(options.models / options.model), resolution=options.resolution, **PLAIN)
    scene, camera = in_view(surfels, options.size, fov=FIELD_OF_VIEW)
    settings = Settings(outputs=("color",), shadow_resolution=0, profile=True)
    (instance,) = scene.surfels
    levels, seen = hierarchy_of(surfels), sight(instance, camera, False, settings.detail_tolerance)
    splats = packed(surfels, levels.nodes, entries_of(levels, cut_blocks(levels.blocks, seen)))
    trial = Trial(device, splats, instance.model_view(camera), options.size)
    frame = partial(passes_of_frame, device, partial(Renderer(device).render, scene, camera, settings))
    jobs = {"frame": frame, **{name: partial(trial.run, name) for name in trial.jobs}}
    taken = in_turn(jobs, options.turns, lambda job: (job(), None))

    def ratio(name: str, units: list[float]) -> str:
        return f"{np.median(np.divide(taken.values[name], units)):.2f}"

    cells = []
    for name in PASSES:
        engine = [passes[name] for passes in taken.values["frame"]]
        cells += f"{np.median(engine):.2f}", ratio(name, engine)
    vertices = ratio("one pixel", taken.values["triangles"])
    report.table(COLUMNS, [(f"{len(surfels):,}", f"{len(splats):,}", *cells, vertices)])


def packed(surfels, nodes, entries: np.ndarray) -> np.ndarray:
    """(n, 16) float32 of the surfels and nodes of a cut: position, half-axis, half-axis, each with a component of the
    normal, and the colour."""
    are_own = entries < len(surfels)

    def field(name: str) -> np.ndarray:
        own, merged = (getattr(of, name) for of in (surfels, nodes))
        return np.concatenate([own[entries[are_own]], merged[entries[~are_own] - len(surfels)]])

    axes = axes_columns(field("rotations"), 0, 1)
    half = [axis.T * length[:, None] for axis, length in zip(axes, field("scales").T, strict=True)]
    columns = zip((field("positions"), *half), field("normals").T, strict=True)
    return np.column_stack([*(each for pair in columns for each in pair), field("colors")]).astype(np.float32)


class Trial:
    """The passes of the trial. model_view: 4 x 4."""

    def __init__(self, device: Device, splats: np.ndarray, model_view: np.ndarray, size: int):
        self._context, self._count, self._size = device._context, len(splats), size
        self._has_queries, context = has_timer_queries(device), device._context
        self._splats = context.buffer(splats.tobytes())
        self._sums = context.buffer(reserve=8 * 4 * size**2)
        self._depth = context.texture((size, size), 1, dtype="u4")
        visibility, attributes = (
            context.compute_shader(COMPUTE.replace("REACH", reach) + visit) for visit, reach in REACH.items()
        )
        triangles = context.program(vertex_shader=TRIANGLES, fragment_shader=DISC)
        for program in (visibility, attributes, triangles):
            values = {"view": model_view.T.astype(np.float32), "focal": np.float32(1 / np.tan(FIELD_OF_VIEW / 2))}
            values |= {"count": np.int32(self._count), "size": np.int32(size)}
            for name, value in values.items():
                if name in program:
                    program[name].write(value.tobytes())
        self._triangles = context.vertex_array(triangles, [])
        self._targets = {n: context.framebuffer(depth_attachment=context.depth_texture((n, n))) for n in {1, size}}
        self.jobs = {
            "visibility": partial(self._compute, visibility),
            "attributes": partial(self._compute, attributes),
            "triangles": partial(self._draw, size),
            "one pixel": partial(self._draw, 1),
        }

    def run(self, name: str) -> float:
        """Milliseconds of a pass. Attributes need the depth of the visibility pass before."""
        self._splats.bind_to_storage_buffer(0)
        self._sums.bind_to_storage_buffer(1)
        self._depth.bind_to_image(0, read=True, write=True)
        if name == "visibility":
            self._depth.write(np.full((self._size, self._size), np.float32(3.4e38)).tobytes())
        self._sums.clear()
        self._context.finish()
        started, query = perf_counter(), self._context.query(time=True)
        with query:
            self.jobs[name]()
        self._context.finish()
        return query.elapsed / 1e6 if self._has_queries else 1e3 * (perf_counter() - started)

    def _compute(self, program) -> None:
        program.run(-(-self._count // GROUP))
        self._context.memory_barrier()

    def _draw(self, size: int) -> None:
        self._targets[size].use()
        self._targets[size].clear(depth=1.0)
        self._context.enable_only(moderngl.DEPTH_TEST)
        self._triangles.render(vertices=3 * self._count)


def passes_of_frame(device: Device, render) -> dict[str, float]:
    """Milliseconds of the engine's passes."""
    if not has_timer_queries(device):
        return render().stats["passes"]
    with timed_draws(device) as spent:
        render()
    return {name: sum(ms for pipeline, ms in spent.items() if pipeline.startswith(name)) for name in PASSES}
