# SPDX-License-Identifier: GPL-3.0-or-later
"""The device outside Blender: moderngl, on EGL where available; for scripts, measurements and tests."""

from __future__ import annotations

import ctypes
import sys
from functools import lru_cache, partial
from weakref import WeakSet

import numpy as np

from .interface import FORMATS, PROGRAMS, PipelineDescription, check_memory, check_texture_size

_GL_TEXTURE_2D_MULTISAMPLE, _GL_TEXTURE_SAMPLES, _GL_SAMPLE_SHADING = 0x9100, 0x9106, 0x8C36
_GL_TEXTURE_2D, _GL_DEPTH_COMPONENT, _GL_FLOAT, _GL_DEPTH_COMPONENT32F = 0x0DE1, 0x1902, 0x1406, 0x8CAC

#: format -> moderngl's name, and the data type that it expects if not float32
_STORED = {
    "RGBA16F": ("f2", np.float16),
    "RGBA16": ("nu2", lambda data: np.rint(np.multiply(data, 65535.0)).astype(np.uint16)),
}


class StandaloneDevice:
    """Creates its own context. Raises RuntimeError if that fails."""

    kind = "standalone"
    most_bytes = None
    backend = "OpenGL"

    def __init__(self):
        try:
            import moderngl
        except ImportError as error:
            raise RuntimeError("The standalone device needs the package moderngl; install it with pip.") from error
        if "bpy" in sys.modules:
            raise RuntimeError(
                "The standalone device takes Blender's graphics context away; open it in a process without bpy."
            )
        try:
            self._context = _context(moderngl)
        except Exception as error:
            raise RuntimeError(f"No OpenGL 3.3 context could be made without a window: {error}") from error
        self._context.gc_mode = "auto"
        self.renderer = self._context.info["GL_RENDERER"]
        self.version = self._context.info["GL_VERSION"]
        self.max_samplers = self._context.info["GL_MAX_TEXTURE_IMAGE_UNITS"]
        self.textures = WeakSet()
        self._uniforms = {}
        self.pipeline = lru_cache(PROGRAMS)(partial(_Pipeline, self._context))
        self._set_sample_shading = _sample_shading(self._context)
        self.multisample_counts = tuple(n for n in (2, 4, 8) if _has_multisampling(self._context, n))

    def texture(self, size, format, data=None, samples=0):
        check_texture_size(size, self._context.info["GL_MAX_TEXTURE_SIZE"])
        check_memory(self, size, format, samples)
        made = _Texture(self._context, size, format, data, samples)
        self.textures.add(made)
        return made

    def write(self, texture, first, data):
        _, stored = _STORED.get(texture.format, ("f4", np.float32))
        texture.handle.write(np.ascontiguousarray(stored(data)).tobytes(), (0, first, data.shape[1], len(data)))

    def target(self, colors, depth=None):
        return _Target(self._context, colors, depth)

    def draw_triangles(self, pipeline, target, triangles, blocks, textures, viewport=None, first=0):
        if triangles:
            self._bind(pipeline, target, blocks, textures, viewport)
            pipeline.vertex_array.render(vertices=3 * triangles, first=3 * first)

    def draw_fullscreen(self, pipeline, target, blocks, textures, viewport=None):
        self.draw_triangles(pipeline, target, 1, blocks, textures, viewport)

    def changed(self, block):
        """Nothing: `_uniform` compares values."""

    def finish(self, target):
        self._context.finish()

    def restore(self):
        self._context.gc()

    def _bind(self, pipeline, target, blocks, textures, viewport=None):
        context, description = self._context, pipeline.description
        target.framebuffer.use()
        context.viewport = viewport or (0, 0, *target.size)
        context.enable_only(
            (context.BLEND if description.blend == "add" else 0) | (context.DEPTH_TEST if description.depth_test else 0)
        )
        context.blend_func = context.ONE, context.ONE
        context.depth_func = "<="
        target.framebuffer.depth_mask = description.depth_write
        self._set_sample_shading(description.sample_shading)
        for slot, texture in enumerate(textures):
            texture.handle.use(slot)
        for slot, block in enumerate(blocks):
            self._uniform(slot, block).bind_to_uniform_block(slot)

    def _uniform(self, slot, block):
        """A buffer with the block's values; an existing one is reused if it was drawn already or holds the same
        values."""
        data = np.ascontiguousarray(block, np.float32).tobytes()
        buffer, held = self._uniforms.get((slot, len(data)), (None, None))
        if held != data:
            buffer = buffer or self._context.buffer(reserve=len(data), dynamic=True)
            buffer.orphan()
            buffer.write(data)
            self._uniforms[slot, len(data)] = buffer, data
        return buffer


def _context(moderngl):
    """A context of OpenGL 4.3, as Blender's, or of 3.3: some drivers give exactly the version that is asked for."""
    options = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    try:
        return moderngl.create_context(standalone=True, require=430, **options)
    except Exception:
        return moderngl.create_context(standalone=True, require=330, **options)


class _Texture:
    def __init__(self, context, size, format, data, samples):
        self.size, self.format, self.samples = tuple(size), format, samples
        if format == "DEPTH32F":
            self.handle = context.depth_texture(self.size, samples=samples)
            _respecify_depth_as_32f(context, self.handle, samples)
        else:
            kind, stored = _STORED.get(format, ("f4", np.float32))
            values = None if data is None else np.ascontiguousarray(stored(data)).tobytes()
            self.handle = context.texture(self.size, FORMATS[format], values, samples=samples, dtype=kind)
            if not samples:
                self.handle.filter = context.NEAREST, context.NEAREST


class _Target:
    def __init__(self, context, colors, depth):
        self.size = (colors[0] if colors else depth).size
        self._colors = colors
        self.framebuffer = context.framebuffer([c.handle for c in colors], depth and depth.handle)

    def clear(self, color=None, depth=None):
        # moderngl clears everything at once but honours write masks, so each half is masked by hand.
        framebuffer, is_masked = self.framebuffer, bool(self._colors) and color is None
        framebuffer.depth_mask = depth is not None
        if is_masked:
            framebuffer.color_mask = self._mask(False)
        value = tuple(color) if hasattr(color, "__len__") else (color or 0.0,) * 4
        framebuffer.clear(*value, depth=1.0 if depth is None else depth)
        if is_masked:
            framebuffer.color_mask = self._mask(True)

    def _mask(self, is_written):
        """Color mask in moderngl's format: without a list for a single texture."""
        masks = [(is_written,) * 4] * len(self._colors)
        return masks[0] if len(masks) == 1 else masks

    def read(self, slot):
        width, height = self.size
        channels = FORMATS[self._colors[slot].format]
        data = self.framebuffer.read(components=channels, attachment=slot, dtype="f4", alignment=1)
        return np.frombuffer(data, np.float32).reshape(height, width, channels)


class _Pipeline:
    def __init__(self, context, description: PipelineDescription):
        self.description = description
        try:
            self.program = context.program(
                vertex_shader=_declared(description, description.vertex, "out"),
                fragment_shader=_declared(description, description.fragment, "in"),
            )
        except Exception as error:
            raise RuntimeError(f"The shader of pipeline {description.name} does not compile: {error}") from error
        for slot, name in enumerate(description.samplers):
            if name in self.program:
                self.program[name].value = slot
        for slot, (struct, _, _) in enumerate(description.blocks):
            if struct + "Block" in self.program:
                self.program[struct + "Block"].binding = slot
        self.vertex_array = context.vertex_array(self.program, [])


def _declared(description: PipelineDescription, source: str, varying: str) -> str:
    lines = ["#version 330"]
    lines += [f"#define {name} {value}" for name, value in description.defines]
    for struct, instance, fields in description.blocks:
        members = " ".join(f"{kind} {name};" for kind, name in fields)
        lines += [
            f"struct {struct} {{ {members} }};",
            f"layout(std140) uniform {struct}Block {{ {struct} {instance}; }};",
        ]
    kinds = {name: "sampler2DMS" for name in description.multisampled}
    lines += [f"uniform {kinds.get(name, 'sampler2D')} {name};" for name in description.samplers]
    # What is evaluated once a pixel is evaluated where a sample is covered, not at a centre outside the triangle.
    smooth = "smooth" if description.sample_shading else "centroid"
    qualifiers = {"smooth": smooth, "flat": "flat"}
    lines += [f"{qualifiers[how]} {varying} {kind} {name};" for how, kind, name in description.varyings]
    if varying == "in":
        lines += [f"layout(location = {n}) out {kind} {name};" for n, (kind, name) in enumerate(description.outputs)]
    return "\n".join(lines) + "\n#line 1\n" + source


def _respecify_depth_as_32f(context, texture, samples):
    """moderngl creates a 24-bit depth buffer, which costs up to 50 dB at a near plane of 1e-4; Blender's is 32-bit
    float."""
    integer, unsigned, pointer = ctypes.c_int, ctypes.c_uint, ctypes.c_void_p
    bind = _gl(context, "glBindTexture", unsigned, unsigned)
    if samples:
        bind(_GL_TEXTURE_2D_MULTISAMPLE, texture.glo)
        image = _gl(context, "glTexImage2DMultisample", unsigned, integer, unsigned, integer, integer, ctypes.c_ubyte)
        image(_GL_TEXTURE_2D_MULTISAMPLE, samples, _GL_DEPTH_COMPONENT32F, *texture.size, 1)
        return
    bind(_GL_TEXTURE_2D, texture.glo)
    image = _gl(context, "glTexImage2D", unsigned, *(integer,) * 5, unsigned, unsigned, pointer)
    image(_GL_TEXTURE_2D, 0, _GL_DEPTH_COMPONENT32F, *texture.size, 0, _GL_DEPTH_COMPONENT, _GL_FLOAT, None)


def _has_multisampling(context, samples) -> bool:
    """Whether a texture with this number of samples really has them, and no more."""
    if samples > context.max_samples:
        return False
    texture, given = context.texture((1, 1), 4, samples=samples, dtype="f4"), ctypes.c_int()
    _gl(context, "glBindTexture", ctypes.c_uint, ctypes.c_uint)(_GL_TEXTURE_2D_MULTISAMPLE, texture.glo)
    ask = _gl(context, "glGetTexLevelParameteriv", ctypes.c_uint, ctypes.c_int, ctypes.c_uint, ctypes.c_void_p)
    ask(_GL_TEXTURE_2D_MULTISAMPLE, 0, _GL_TEXTURE_SAMPLES, ctypes.byref(given))
    return given.value == samples


def _sample_shading(context):
    """set(True) runs fragment shaders for every sample (OpenGL 4.0), set(False) once per pixel."""
    if context.version_code < 400:

        def refuse(on):
            if on:
                raise RuntimeError(f"Shading every sample needs OpenGL 4.0, not {context.version_code / 100}.")

        return refuse
    enable, disable = (_gl(context, name, ctypes.c_uint) for name in ("glEnable", "glDisable"))
    _gl(context, "glMinSampleShading", ctypes.c_float)(1.0)
    return lambda on: (enable if on else disable)(_GL_SAMPLE_SHADING)


def _gl(context, name, *argument_types):
    """An OpenGL function that moderngl does not wrap."""
    return ctypes.CFUNCTYPE(None, *argument_types)(context.mglo._context.load_opengl_function(name))
