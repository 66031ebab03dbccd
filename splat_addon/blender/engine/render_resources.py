# SPDX-License-Identifier: GPL-3.0-or-later
"""What the frames and view layers of one render share, as long as Blender has no place for it."""

from __future__ import annotations

import sys
from weakref import ref

import bpy

from ...rendering import Renderer, open_device
from ..doors import unattended, with_handlers
from ..export.changes import Changes, changes_of
from ..export.live_meshes import LiveMeshes
from ..export.surfel_store import SurfelStore
from ..materials import matcap_images
from ..preferences import most_bytes
from .targets import Targets


class Resources:
    """Resources shared by the frames and view layers of one render.

    They belong to this module and not to the engine's instance, because Blender frees the instance, and calls handlers,
    without a graphics context. Freeing textures then aborts Blender 4.5 and spoils the next render on 5.2's OpenGL. So
    they are freed in `render` after the last picture, unless the scene's Persistent Data keeps them. A render that ends
    before the scene's last frame, because of Esc or a shorter range, also leaves them to the next render.

    are_images_edited: whether images may have been edited since the last picture. changes: what evaluations changed
    since the scene was last read; None: anything. most: surfels of a sampled mesh.
    """

    def __init__(self, most: int | None = None):
        self.are_images_edited = False
        self.store = SurfelStore()
        self.live_meshes = LiveMeshes(most)
        self.targets = Targets()
        self.renderer = Renderer(open_device("blender"))
        self.changes: Changes | None = None
        self._engine: ref | None = None

    def note_changes(self, engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> None:
        """Remember what an evaluation changed: Blender forgets it with the next one. The depsgraph is an engine's own;
        nothing is known of what came before it."""
        is_followed = self._engine is not None and self._engine() is engine
        self._engine = ref(engine)
        self.changes = self.changes | changes_of(depsgraph) if is_followed and self.changes is not None else None


#: The resources of the render that is going on, or of the last one, if it left them.
_kept: Resources | None = None


@unattended("Looking for edited images")
def _before_render(*_) -> None:
    """Look again at all images: Blender does not tell what was edited since the last render."""
    matcap_images.doubt()
    if _kept:
        _kept.are_images_edited = True


def acquired() -> Resources:
    """The resources of the render that is going on; they are made if there are none."""
    global _kept
    _kept = _kept or Resources()
    _kept.renderer.device.most_bytes = most_bytes()
    return _kept


def release() -> None:
    """Free what is there."""
    global _kept
    if _kept:
        _kept.renderer.release()
    _kept = None


def is_last_of_render(engine: bpy.types.RenderEngine, depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether the render ends with the picture that the engine draws."""
    scene = depsgraph.scene
    later_frames = engine.is_animation and scene.frame_current + scene.frame_step <= scene.frame_end
    if later_frames and not _ARE_FRAMES_NAMED:
        return False
    layers = [layer.name for layer in scene.view_layers if layer.use]
    return scene.render.use_single_layer or depsgraph.view_layer.name in layers[-1:]


#: `blender --background -f 1,5` treats each of its frames as an animation, and none as the last.
_ARE_FRAMES_NAMED = bool({"-f", "--render-frame"} & set(sys.argv))


register, unregister = with_handlers((bpy.app.handlers.render_init, _before_render))
