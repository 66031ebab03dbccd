# SPDX-License-Identifier: GPL-3.0-or-later
"""Graphics devices: one interface (`interface.py`) and two implementations for different graphics APIs.

`blender_gpu` draws through Blender's `gpu` module (OpenGL, Vulkan, Metal), `standalone` through moderngl on EGL. The
latter needs its own process, because moderngl takes over Blender's context if both run in one.
"""

from .interface import Device

#: name -> module and class; the module is imported only when needed.
DEVICES = {
    "blender": ("blender_gpu", "BlenderDevice"),
    "standalone": ("standalone", "StandaloneDevice"),
}


def open_device(name: str) -> Device:
    """A device by name: "blender" (inside Blender's render or draw callbacks) or "standalone" (no Blender).

    Raises ValueError for an unknown name and RuntimeError if the device cannot be opened.
    """
    from importlib import import_module

    if name not in DEVICES:
        raise ValueError(f"A device is one of {', '.join(DEVICES)}, not {name!r}.")
    module, maker = DEVICES[name]
    return getattr(import_module(f".{module}", __package__), maker)()


__all__ = ("Device", "open_device")
