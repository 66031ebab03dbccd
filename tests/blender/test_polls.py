# SPDX-License-Identifier: GPL-3.0-or-later
"""An operator that cannot be called gives the reason in a sentence."""

import bpy
import pytest

from splat_addon.blender import ids

#: Operators that can be called at any time: they change settings, or open a file dialog.
ALWAYS = {
    ids.RENDER_PRESET,
    ids.SHOW_SURFELS,
    ids.SCAN_LOOK,
    ids.IMPORT_FILE,
    ids.ADD_RENDER_PRESET,
    ids.ADD_CONVERSION_PRESET,
}
OURS = sorted(
    value for name, value in vars(ids).items() if name.isupper() and isinstance(value, str) and value.count(".") == 1
)


def call(idname):
    module, _, name = idname.partition(".")
    return getattr(getattr(bpy.ops, module), name)


@pytest.mark.parametrize("idname", [idname for idname in OURS if idname not in ALWAYS])
@pytest.mark.parametrize("mode", ["nothing selected", "edit mode"])
def test_a_refused_call_says_why(idname, mode):
    if mode == "edit mode":
        bpy.ops.mesh.primitive_cube_add()
        bpy.ops.object.mode_set(mode="EDIT")
    assert not call(idname).poll()
    with pytest.raises(RuntimeError) as refused:
        call(idname)()
    reason = str(refused.value).partition("poll() ")[2].strip()
    assert len(reason.split()) >= 5 and "context is incorrect" not in reason


def test_every_operator_is_looked_at():
    registered = {o.bl_idname for o in bpy.types.Operator.__subclasses__() if o.__module__.startswith("splat_addon")}
    assert registered <= set(OURS) and len(OURS) >= 9


@pytest.mark.parametrize("idname", sorted(ALWAYS))
def test_what_has_no_poll_can_be_called_in_an_empty_scene(idname):
    assert call(idname).poll()
