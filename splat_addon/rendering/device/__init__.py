# SPDX-License-Identifier: GPL-3.0-or-later
"""The graphics devices: one interface (`interface.py`), two makers that know a graphics API.

`blender_gpu` draws through Blender's `gpu` module (OpenGL, Vulkan, Metal), `standalone` through moderngl on EGL
in a process of its own: moderngl takes Blender's context away when both live in one.
"""

from .interface import Device

#: name -> module and class; the module is imported only when it is asked for.
DEVICES = {
    "blender": ("blender_gpu", "BlenderDevice"),
    "standalone": ("standalone", "StandaloneDevice"),
}


def open_device(name: str) -> Device:
    """A device by name: "blender" (inside Blender's render or draw callbacks) or "standalone" (no Blender).

    Raises ValueError for another name and RuntimeError where the device cannot be opened here.
    """
    from importlib import import_module

    if name not in DEVICES:
        raise ValueError(f"A device is one of {', '.join(DEVICES)}, not {name!r}.")
    module, maker = DEVICES[name]
    return getattr(import_module(f".{module}", __package__), maker)()


__all__ = ("Device", "open_device")
