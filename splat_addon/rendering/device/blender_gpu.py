# SPDX-License-Identifier: GPL-3.0-or-later
"""The device inside Blender: its `gpu` module, on whichever backend Blender runs (OpenGL, Vulkan, Metal).

Two properties of that module shape this file: it does not keep resources alive that Python frees before the device has
drawn (Vulkan then crashes), and its state leaks into Blender's own drawing.
"""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from weakref import WeakSet

import numpy as np

from .interface import FORMATS, PROGRAMS, PipelineDescription, check_memory, check_texture_size

#: Copies the texels of one texture into another, from row `place.rows.y` on.
_ROWS = PipelineDescription(
    "rows",
    (Path(__file__).resolve().parents[3] / "shaders/hosts/fullscreen.vert.glsl").read_text(encoding="utf-8"),
    "void main() { texel = texelFetch(source, ivec2(gl_FragCoord.xy - place.rows.xy), 0); }",
    (("Place", "place", (("vec4", "rows"),)),),
    samplers=("source",),
    outputs=(("vec4", "texel"),),
)

_FORMAT_NAMES = {"DEPTH32F": "DEPTH_COMPONENT32F"}
_BLEND_NAMES = {"none": "NONE", "add": "ADDITIVE_PREMULT"}


class BlenderDevice:
    """Works inside RenderEngine callbacks, in the window, and (from 5.2) after gpu.init(); otherwise raises
    RuntimeError."""

    kind = "blender"
    multisample_counts = ()
    most_bytes = None

    def __init__(self):
        try:
            import gpu
        except ImportError as error:
            raise RuntimeError("The blender device needs Blender's own Python (the gpu module).") from error
        try:
            self.backend = {"OPENGL": "OpenGL", "VULKAN": "Vulkan", "METAL": "Metal"}.get(
                gpu.platform.backend_type_get(), gpu.platform.backend_type_get()
            )
            self.renderer = gpu.platform.renderer_get()
            self.version = gpu.platform.version_get()
            self.max_samplers = gpu.capabilities.max_textures_frag_get()
        except SystemError as error:
            raise RuntimeError(
                "Blender has no graphics context here: in background mode it has one only inside a render."
            ) from error
        self._gpu = gpu
        self.pipeline = _shared_pipeline
        self.textures = WeakSet()
        self._in_flight = []
        self._uniforms = {}
        self._triangles = (0, None)
        self._triangle = _batch(gpu, 1)

    def texture(self, size, format, data=None, samples=0):
        if samples:
            raise ValueError("Blender's gpu module has no multisampled textures.")
        check_texture_size(size, self._gpu.capabilities.max_texture_size_get())
        check_memory(self, size, format)
        made = _Texture(self._gpu, size, format, data)
        self.textures.add(made)
        return made

    def write(self, texture, first, data):
        # `gpu` cannot write into a texture that exists, so another one is drawn into it
        rows = self.texture((data.shape[1], len(data)), texture.format, data)
        place, viewport = np.array([0, first, 0, 0], np.float32), (0, first, *rows.size)
        self.draw_fullscreen(self.pipeline(_ROWS), self.target([texture]), [place], [rows], viewport)

    def target(self, colors, depth=None):
        return _Target(self._gpu, colors, depth)

    def draw_triangles(self, pipeline, target, triangles, blocks, textures, viewport=None, first=0):
        if not triangles:
            return
        if self._triangles[0] < first + triangles:
            # Round up to a power of two, so that it grows only a few times.
            size = 1 << max(first + triangles - 1, 1023).bit_length()
            self._triangles = size, _batch(self._gpu, size)
        self._draw(pipeline, target, blocks, textures, self._triangles[1], (3 * first, 3 * triangles), viewport)

    def draw_fullscreen(self, pipeline, target, blocks, textures, viewport=None):
        self._draw(pipeline, target, blocks, textures, self._triangle, None, viewport)

    def changed(self, block):
        self._uniforms.pop(id(block), None)

    def finish(self, target):
        target.read_one()

    def restore(self):
        state = self._gpu.state
        state.blend_set("NONE")
        state.depth_test_set("NONE")
        state.depth_mask_set(False)
        self._in_flight.clear()
        self._uniforms.clear()

    def _draw(self, pipeline, target, blocks, textures, batch, vertices, viewport=None):
        gpu, description, shader = self._gpu, pipeline.description, pipeline.shader
        uniforms = [self._uniform(block) for block in blocks]
        self._in_flight.append((uniforms, textures, pipeline, target, batch))
        with target.framebuffer.bind():
            # the frame buffer's own method takes no arguments in Blender 4.5
            gpu.state.viewport_set(*(viewport or (0, 0, *target.size)))
            gpu.state.blend_set(_BLEND_NAMES[description.blend])
            gpu.state.depth_test_set("LESS_EQUAL" if description.depth_test else "NONE")
            gpu.state.depth_mask_set(description.depth_write)
            shader.bind()
            for (_, instance, _), values in zip(description.blocks, uniforms, strict=True):
                shader.uniform_block(instance, values)
            for name, texture in zip(description.samplers, textures, strict=True):
                shader.uniform_sampler(name, texture.handle)
            if vertices is None:
                batch.draw(shader)
            else:
                batch.draw_range(shader, elem_start=vertices[0], elem_count=vertices[1])

    def _uniform(self, block):
        """The uniform buffer of an array; both live equally long."""
        if id(block) not in self._uniforms:
            self._uniforms[id(block)] = block, self._gpu.types.GPUUniformBuf(np.ascontiguousarray(block, np.float32))
        return self._uniforms[id(block)][1]


class _Texture:
    def __init__(self, gpu, size, format, data):
        self.size, self.format, self.samples = tuple(size), format, 0
        options = {}
        if data is not None:
            values = np.ascontiguousarray(_whole_steps(data) if format == "RGBA16" else data, np.float32)
            options["data"] = gpu.types.Buffer("FLOAT", values.size, values.ravel())
        try:
            self.handle = gpu.types.GPUTexture(self.size, format=_FORMAT_NAMES.get(format, format), **options)
        except Exception as error:
            raise RuntimeError(
                f"The graphics device makes no texture of {size[0]:,} x {size[1]:,} {format} ({error}); draw fewer "
                "surfels or a smaller picture."
            ) from error


def _whole_steps(data):
    """Numbers that become the nearest of 65,535 steps, whether they are rounded or cut off: Blender's own conversion
    for Vulkan cuts off (`vk_data_conversion.cc`)."""
    return (np.rint(np.multiply(data, 65535.0)) + 0.25) / 65535


class _Target:
    def __init__(self, gpu, colors, depth):
        self._gpu = gpu
        self.size = (colors[0] if colors else depth).size
        self._colors, self._depth = colors, depth  # the framebuffer does not keep them alive
        slots = {"color_slots": [c.handle for c in colors]} if colors else {}
        if depth:
            slots["depth_slot"] = depth.handle
        self.framebuffer = gpu.types.GPUFrameBuffer(**slots)

    def clear(self, color=None, depth=None):
        values = {}
        if color is not None:
            values["color"] = tuple(np.broadcast_to(color, 4).tolist())
        if depth is not None:
            values["depth"] = depth
        with self.framebuffer.bind():
            self._gpu.state.depth_mask_set(True)
            self.framebuffer.clear(**values)

    def read(self, slot):
        width, height = self.size
        return self._read(slot, width, height, FORMATS[self._colors[slot].format])

    def read_one(self):
        """Read one pixel, which waits for the device to finish."""
        if self._colors:
            self._read(0, 1, 1, FORMATS[self._colors[0].format])
        else:
            with self.framebuffer.bind():
                self.framebuffer.read_depth(0, 0, 1, 1)

    def _read(self, slot, width, height, channels):
        # a Buffer over numpy memory: no copy, and it avoids the stride bug of Blender 4.5 to 5.1
        pixels = np.empty((height, width, channels), np.float32)
        with self.framebuffer.bind():
            self.framebuffer.read_color(
                0, 0, width, height, channels, slot, "FLOAT", data=self._gpu.types.Buffer("FLOAT", pixels.shape, pixels)
            )
        return pixels


class _Pipeline:
    def __init__(self, gpu, description: PipelineDescription):
        self.description = description
        types = gpu.types
        info = types.GPUShaderCreateInfo()
        structs = []
        for slot, (struct, instance, fields) in enumerate(description.blocks):
            members = " ".join(f"{kind} {name};" for kind, name in fields)
            structs.append(f"struct {struct} {{ {members} }};\n")
            info.uniform_buf(slot, struct, instance)
        info.typedef_source("".join(structs))
        for name, value in description.defines:
            info.define(name, value)
        if description.varyings:
            interface = types.GPUStageInterfaceInfo(f"{description.name}_varyings")
            for interpolation, kind, name in description.varyings:
                getattr(interface, interpolation)(kind.upper(), name)
            info.vertex_out(interface)
        for slot, name in enumerate(description.samplers):
            info.sampler(slot, "FLOAT_2D", name)
        for slot, (kind, name) in enumerate(description.outputs):
            info.fragment_out(slot, kind.upper(), name)
        if description.fragment_depth:
            info.depth_write("ANY")
        info.vertex_source(description.vertex)
        info.fragment_source(description.fragment)
        try:
            self.shader = gpu.shader.create_from_info(info)
        except Exception as error:
            raise RuntimeError(
                f"The shader of pipeline {description.name} does not compile ({error}); the driver's log is on stderr."
            ) from error


@lru_cache(PROGRAMS)
def _shared_pipeline(description: PipelineDescription) -> _Pipeline:
    """Blender's contexts share programs, so all devices and renders of the process share them too."""
    import gpu

    return _Pipeline(gpu, description)


def _batch(gpu, triangles):
    """A batch without attributes: the vertex shader fetches its data from textures."""
    types = gpu.types
    return types.GPUBatch(type="TRIS", buf=types.GPUVertBuf(types.GPUVertFormat(), 3 * triangles))
