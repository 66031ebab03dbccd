# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeps the colours of surfels true: when a material, an image or a slot that they were made from was edited, they are
painted again, in the 3D view a moment after each edit and before a render.

What is not painted is said, in the sidebar and with a picture: surfels that do not follow their source, those in linked
files and in files of their own, and those whose source was deleted or has other faces.
"""

from __future__ import annotations

import threading
import time

import bpy
import numpy as np
from mathutils import Vector

from ...faults import sentence_of
from ..doors import unattended, with_handlers
from ..geometry.node_groups import nodes_in
from ..ids import PAINTED_AS
from ..materials.fingerprints import forget_images
from ..materials.image_files import SEQUENCE
from .painted_as import PaintedAs, painted_as
from .repainting import Repaint, told_now
from .source_record import sources_of

#: Seconds after an edit, and those that a part of the work may take before the window goes on.
_DELAY, _AT_ONCE = 0.05, 0.05

#: session_uid of a mesh -> what its surfels should be painted as, and the end of a sentence that says why they cannot.
_failed: dict[int, tuple[PaintedAs, str]] = {}

#: session_uids of what the colours in the view layer were made from; None: not known.
_known: set[int] | None = None

#: The job in progress, and what it will be painted as.
_job: tuple[Repaint, int] | None = None


def why_out_of_date(made: bpy.types.Object) -> str | None:
    """The end of a sentence about an object whose surfels have other colours than their materials; None if they are
    true, as far as the last edit told."""
    failed = _failed.get(made.data.session_uid) if made.type == "MESH" else None
    return failed and failed[1]


def out_of_date(made: bpy.types.Object) -> str | None:
    """The same as a sentence, or one about materials that change from frame to frame."""
    if why := why_out_of_date(made):
        return f"The colours of {made.name!r} are out of date: {why}; update its surfels"
    for material in filter(_is_animated, getattr(made.data, "materials", ())):
        return (
            f"The material {material.name!r} of {made.name!r} is animated, and surfels keep the colours of one frame; "
            "hide them so that their source is drawn"
        )
    return None


def _is_animated(material: bpy.types.Material | None) -> bool:
    tree = material and material.node_tree
    if not tree:
        return False
    known = tree.animation_data
    images = (getattr(node, "image", None) for node in nodes_in(tree))
    is_moving = any(image is not None and image.source == SEQUENCE for image in images)
    return is_moving or bool(known and (known.action or known.drivers))


def refresh(context: bpy.types.Context) -> None:
    """Paint all surfels of the view layer whose colours are not true."""
    while _work(context, time.monotonic() + 3600):
        pass


def _work(context: bpy.types.Context, until: float) -> bool:
    """Paint until then, what is visible first; returns whether there is more to do."""
    global _job
    while time.monotonic() < until:
        if _job is None:
            stale = _stale(context)
            if not stale:
                return False
            made = _first_seen(stale, context)
            try:
                _job = Repaint(made, context), made.data.session_uid
            except Exception as error:
                _fail(made, sentence_of(error))
                continue
        repaint, uid = _job
        try:
            if repaint.step():
                continue
            _job = None
            repaint.finish()
            _failed.pop(uid, None)
        except ReferenceError:
            _job = None  # it was deleted meanwhile
        except Exception as error:
            _job = None
            _fail(repaint.made, sentence_of(error))
    return True


def _fail(made: bpy.types.Object, why: str) -> None:
    _failed[made.data.session_uid] = told_now(made, painted_as(made.data)), why.rstrip(".")


def _stale(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The objects of the view layer whose colours are not true, one for each mesh, but for those that failed so."""
    global _known
    found, materials, _known = {}, {}, set()
    for made in context.view_layer.objects:
        before = painted_as(made.data) if made is not None and made.type == "MESH" else None
        if before is None or made.data.session_uid in found:
            continue
        used = [made, *sources_of(made)]
        _known.update(each.session_uid for owner in used for each in (owner, owner.data) if each is not None)
        now, failed = told_now(made, before, materials), _failed.get(made.data.session_uid)
        if now == before:
            _failed.pop(made.data.session_uid, None)
        elif failed is None or failed[0] != now:
            found[made.data.session_uid] = made
    return list(found.values())


def _first_seen(found: list[bpy.types.Object], context: bpy.types.Context) -> bpy.types.Object:
    """The object that is in a 3D view, or else is visible."""
    window = context.window_manager.windows if context.window_manager else ()
    areas = (area for each in window for area in each.screen.areas if area.type == "VIEW_3D")
    views = [np.array(area.spaces.active.region_3d.perspective_matrix) for area in areas]
    return max(found, key=lambda made: (any(_is_in(made, view) for view in views), made.visible_get()))


def _is_in(made: bpy.types.Object, view: np.ndarray) -> bool:
    """Whether the box of an object is not beside a view, as far as one side tells."""
    corners = np.array([[*(made.matrix_world @ Vector(corner)), 1.0] for corner in made.bound_box]) @ view.T
    return made.visible_get() and not any(
        (sign * corners[:, axis] > corners[:, 3]).all() for axis in (0, 1) for sign in (1, -1)
    )


@unattended("Painting surfels again")
def _continue() -> float | None:
    """The timer; it waits while a render reads the meshes in another thread."""
    if bpy.context.mode in _BUSY or bpy.app.is_job_running("RENDER"):
        return _DELAY * 4
    return 0.0 if _work(bpy.context, time.monotonic() + _AT_ONCE) else None


#: Modes in which Blender's data lag behind what is edited.
_BUSY = frozenset({"EDIT_MESH", "EDIT_CURVE", "EDIT_SURFACE", "EDIT_TEXT", "EDIT_METABALL"})


def doubt() -> None:
    """Look at all surfels a moment later."""
    if not bpy.app.background and not bpy.app.timers.is_registered(_continue):
        bpy.app.timers.register(_continue, first_interval=_DELAY)


@unattended("Noticing edited materials")
def _after_update(scene, depsgraph) -> None:
    """Notice edits of what colours are made from; Blender reports an image that was read again as a material whose
    shading stayed the same, and nothing if nobody sees it."""
    updates, is_material = list(depsgraph.updates), depsgraph.id_type_updated("MATERIAL")
    materials = [update for update in updates if isinstance(update.id, bpy.types.Material)]
    has_image = depsgraph.id_type_updated("IMAGE") or (is_material and not updates)
    if has_image or not all(update.is_updated_shading for update in materials):
        forget_images()
    if has_image or is_material or any(map(_concerns, updates)):
        doubt()


def _concerns(update: bpy.types.DepsgraphUpdate) -> bool:
    changes = update.is_updated_geometry or update.is_updated_shading
    if not changes or not isinstance(update.id, bpy.types.Object | bpy.types.Mesh):
        return False
    original = update.id.original
    mesh = original.data if isinstance(original, bpy.types.Object) else original
    is_new = isinstance(mesh, bpy.types.Mesh) and PAINTED_AS in mesh
    return _known is None or is_new or original.session_uid in _known


@unattended("Looking at all surfels")
def _after_load(*_) -> None:
    global _known, _job
    _known = _job = None
    _failed.clear()
    forget_images()
    doubt()


@unattended("Looking at all surfels")
def _after_undo(*_) -> None:
    global _job
    _job = None
    doubt()


@unattended("Painting surfels before a render")
def _before_render(*_) -> None:
    """Nothing may be written while the window goes on in another thread; the timer has done it by then."""
    if threading.current_thread() is threading.main_thread():
        bpy.context.view_layer.update()
        refresh(bpy.context)


_handlers = bpy.app.handlers
register, unregister = with_handlers(
    (_handlers.depsgraph_update_post, _after_update),
    (_handlers.load_post, _after_load),
    (_handlers.undo_post, _after_undo),
    (_handlers.redo_post, _after_undo),
    (_handlers.render_init, _before_render),
)
