# SPDX-License-Identifier: GPL-3.0-or-later
"""The yardstick of the engine's speed: the least that three passes of surfel quads can be on Blender's gpu module.

Visibility, additive attributes and one shading pass, a headlight for light, unit conversions left out. It has no
plan, no methods, no supersampling, no camera-relative precision; `measure_frame.py` times the engine against it.
"""

import gpu
import numpy as np
from gpu.types import (
    Buffer,
    GPUBatch,
    GPUFrameBuffer,
    GPUIndexBuf,
    GPUShaderCreateInfo,
    GPUStageInterfaceInfo,
    GPUTexture,
    GPUUniformBuf,
    GPUVertBuf,
    GPUVertFormat,
)

ROW = 512
VIEW = "struct View { mat4 model_view; mat4 projection; };"
QUAD = """
void main() {
  int s = gl_VertexID >> 2, c = gl_VertexID & 3;
  vec2 k = vec2((c & 1) == 1 ? 1.0 : -1.0, (c & 2) == 2 ? 1.0 : -1.0);
  ivec2 b = ivec2((s % 512) * 4, s / 512);
  vec3 p = texelFetch(surfels, b, 0).xyz;
  vec3 u = texelFetch(surfels, b + ivec2(1, 0), 0).xyz;
  vec3 v = texelFetch(surfels, b + ivec2(2, 0), 0).xyz;
  color = texelFetch(surfels, b + ivec2(3, 0), 0).xyz;
  normal = mat3(view.model_view) * normalize(cross(u, v));
  vec3 e = (view.model_view * vec4(p + u * k.x + v * k.y, 1.0)).xyz;
  uv_depth = vec3(k, -e.z);
  gl_Position = view.projection * vec4(e * (1.0 + offset / length(e)), 1.0);
}"""
VISIBILITY = "void main() { if (dot(uv_depth.xy, uv_depth.xy) > 1.0) discard; }"
ATTRIBUTES = """
void main() {
  float r2 = dot(uv_depth.xy, uv_depth.xy);
  if (r2 > 1.0) discard;
  float w = exp(-2.0 * r2);
  color_sum = vec4(color, 1.0) * w;
  normal_sum = vec4(normal, uv_depth.z) * w;
}"""
FULLSCREEN = "void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }"
SHADE = """
void main() {
  vec4 c = texelFetch(color_sum, ivec2(gl_FragCoord.xy), 0);
  vec4 n = texelFetch(normal_sum, ivec2(gl_FragCoord.xy), 0);
  bool hit = c.w > 1e-6;
  combined = hit ? vec4(c.rgb / c.w * max(normalize(n.xyz).z, 0.0), 1.0) : vec4(0.0);
  distance_out = hit ? n.w / c.w : 1e10;
}"""


class BareProgram:
    """positions, axis_u, axis_v, colors: (N, 3). Everything that can be kept between frames is made here."""

    def __init__(self, positions, axis_u, axis_v, colors, size):
        self.size = size
        self.surfels, self.batch = _upload(positions, axis_u, axis_v, colors)
        self.visibility = _shader(QUAD, VISIBILITY, samplers=("surfels",), surfels=True)
        self.attributes = _shader(
            QUAD, ATTRIBUTES, (("VEC4", "color_sum"), ("VEC4", "normal_sum")), ("surfels",), surfels=True
        )
        self.shade = _shader(
            FULLSCREEN, SHADE, (("VEC4", "combined"), ("FLOAT", "distance_out")), ("color_sum", "normal_sum")
        )
        self.color, self.normal, self.combined = (GPUTexture(size, format="RGBA32F") for _ in range(3))
        self.distance = GPUTexture(size, format="R32F")
        self.depth = GPUTexture(size, format="DEPTH_COMPONENT32F")
        self.triangle = _batch(3)

    def frame(self, model_view, projection, offset):
        """Colour (h, w, 4) and distance (h, w, 1), read back."""
        view = GPUUniformBuf(np.concatenate([np.array(m, np.float32).T.ravel() for m in (model_view, projection)]))
        nearest = GPUFrameBuffer(depth_slot=self.depth)
        sums = GPUFrameBuffer(depth_slot=self.depth, color_slots=[self.color, self.normal])
        final = GPUFrameBuffer(color_slots=[self.combined, self.distance])

        def draw(program, value):
            program.bind()
            program.uniform_block("view", view)
            program.uniform_sampler("surfels", self.surfels)
            program.uniform_float("offset", value)
            self.batch.draw(program)

        try:
            gpu.state.depth_test_set("LESS_EQUAL")
            with nearest.bind():
                gpu.state.depth_mask_set(True)
                nearest.clear(depth=1.0)
                draw(self.visibility, offset)
            with sums.bind():
                gpu.state.depth_mask_set(False)
                gpu.state.blend_set("ADDITIVE_PREMULT")
                sums.clear(color=(0.0, 0.0, 0.0, 0.0))
                draw(self.attributes, 0.0)
            gpu.state.blend_set("NONE")
            gpu.state.depth_test_set("NONE")
            with final.bind():
                self.shade.bind()
                self.shade.uniform_sampler("color_sum", self.color)
                self.shade.uniform_sampler("normal_sum", self.normal)
                self.triangle.draw(self.shade)
                return _read(final, 0, *self.size, 4), _read(final, 1, *self.size, 1)
        finally:
            gpu.state.blend_set("NONE")
            gpu.state.depth_test_set("NONE")
            gpu.state.depth_mask_set(False)


def _shader(vertex, fragment, outputs=(), samplers=(), surfels=False):
    info = GPUShaderCreateInfo()
    if surfels:
        varyings = GPUStageInterfaceInfo("surfel_varyings")
        varyings.smooth("VEC3", "uv_depth")
        varyings.flat("VEC3", "color")
        varyings.flat("VEC3", "normal")
        info.vertex_out(varyings)
        info.typedef_source(VIEW)
        info.uniform_buf(0, "View", "view")
        info.push_constant("FLOAT", "offset")
    for slot, name in enumerate(samplers):
        info.sampler(slot, "FLOAT_2D", name)
    for slot, (kind, name) in enumerate(outputs):
        info.fragment_out(slot, kind, name)
    info.vertex_source(vertex)
    info.fragment_source(fragment)
    return gpu.shader.create_from_info(info)


def _batch(vertices, **elements):
    return GPUBatch(type="TRIS", buf=GPUVertBuf(GPUVertFormat(), vertices), **elements)


def _upload(positions, axis_u, axis_v, colors):
    count, rows = len(positions), -(-len(positions) // ROW)
    texels = np.zeros((rows * ROW, 4, 4), np.float32)
    for slot, values in enumerate((positions, axis_u, axis_v, colors)):
        texels[:count, slot, :3] = values
    texture = GPUTexture((ROW * 4, rows), format="RGBA32F", data=Buffer("FLOAT", texels.size, texels.ravel()))
    corners = np.arange(count, dtype=np.uint32)[:, None] * 4 + np.array([0, 1, 2, 2, 1, 3], np.uint32)
    return texture, _batch(4 * count, elem=GPUIndexBuf(type="TRIS", seq=corners.reshape(-1, 3)))


def _read(framebuffer, slot, width, height, channels):
    pixels = np.empty((height, width, channels), np.float32)
    framebuffer.read_color(0, 0, width, height, channels, slot, "FLOAT", data=Buffer("FLOAT", pixels.shape, pixels))
    return pixels
