# SPDX-License-Identifier: GPL-3.0-or-later
"""A user's own presets are files of Blender's preset system, and restore every setting."""

from pathlib import Path

import bpy
import pytest

#: (operator that adds a preset, its panel, its settings, changes to some of them)
KINDS = {
    "render": (
        lambda **options: bpy.ops.render.surfel_preset_add(**options),
        "RENDER_PT_surfel_presets",
        "surfel_splatting",
        {"method": "quad", "samples": 3, "line_color": (0.5, 0.25, 0.125, 1.0), "use_lines": True},
    ),
    "conversion": (
        lambda **options: bpy.ops.object.surfel_conversion_preset_add(**options),
        "VIEW3D_PT_surfel_conversion_presets",
        "surfel_conversion",
        {"density": "COUNT", "count": 12_345, "clips_edges": False},
    ),
}


@pytest.fixture(params=KINDS)
def kind(request, monkeypatch, tmp_path):
    """One kind of preset, whose files are kept in a folder of this test."""
    monkeypatch.setattr(bpy.utils, "user_resource", lambda *_, path="", **__: _made(tmp_path / path))
    monkeypatch.setattr(bpy.utils, "preset_paths", lambda path: [str(tmp_path / "presets" / path)])
    panel = getattr(bpy.types, KINDS[request.param][1])
    monkeypatch.setattr(panel, "bl_label", panel.bl_label)  # Blender shows in it which preset was chosen last
    return KINDS[request.param], tmp_path


def _made(folder: Path) -> str:
    folder.mkdir(parents=True, exist_ok=True)
    return str(folder)


def values(settings, names):
    return {name: tuple(v) if hasattr(v := getattr(settings, name), "__len__") and not isinstance(v, str) else v
            for name in names}  # fmt: skip


def test_a_preset_brings_all_settings_back(kind):
    (add, panel, owner, changed), folder = kind
    settings = getattr(bpy.context.scene, owner)
    for name, value in changed.items():
        value = value[: len(getattr(settings, name))] if isinstance(value, tuple) else value
        setattr(settings, name, value)
    names = [p.identifier for p in settings.bl_rna.properties if not p.is_readonly and p.identifier not in ("matcap",)]
    kept = values(settings, names)
    assert add(name="mine") == {"FINISHED"}
    [file] = folder.rglob("mine.py")
    for name in changed:
        settings.property_unset(name)
    assert values(settings, names) != kept
    bpy.ops.script.execute_preset(filepath=str(file), menu_idname=panel)
    assert values(getattr(bpy.context.scene, owner), names) == kept


def test_the_conversion_s_operators_have_presets_in_adjust_last_operation():
    for operator in (bpy.types.OBJECT_OT_surfels_from_mesh, bpy.types.OBJECT_OT_surfels_from_points):
        assert "PRESET" in operator.bl_options
