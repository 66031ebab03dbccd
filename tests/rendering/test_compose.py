# SPDX-License-Identifier: GPL-3.0-or-later
"""Shaders are composed of hosts and features, never switched by conditionals, and names of parts never clash."""

import re
from collections import defaultdict

import pytest

from splat_addon.rendering.plan import composition as composing
from splat_addon.rendering.plan.compose import main
from splat_addon.rendering.plan.composition import FOLDER, compose

FILES = sorted(FOLDER.rglob("*.glsl"))
#: Folders from which a shader includes only one file.
CHOICES = {
    "methods",
    "shading_models",
    "storage",
    "depth_formats",
    "sum_formats",
    "samples",
    "background",
    "world_light",
    "lighting_picture",
    "polygon_light",
}
CHOICES |= {
    "shadow_taps",
    "polygon_share",
    "polygon_blend",
    "sides",
    "rest_opacity",
    "faces",
    "instances",
    "polygon_light",
}
#: Files of shaders/lib that two methods have in common.
SHARED = "homogeneous", "raycast", "sprites", "surfel_quad"
GLOBAL = re.compile(r"^(?:const )?(?:struct (\w+)|\w+ (\w+)(?:\[\d*\])?(?:\(| =|;))", re.MULTILINE)


def global_names(text: str) -> set[str]:
    """The names that a text defines outside functions."""
    plain = re.sub(r"//.*", "", text)
    return {a or b for a, b in GLOBAL.findall(plain) if (a or b) != "main"}


def home(file) -> str:
    """The folder of a file if a shader includes only one file of that folder; else the file itself."""
    if file.parent.name == "lib" and file.stem in SHARED:
        return "methods"
    return file.parent.name if file.parent.name in CHOICES else file.relative_to(FOLDER).as_posix()


def test_no_text_is_switched_by_a_conditional():
    for file in FILES:
        switched = re.findall(r"^#(?:if|el|endif).*", file.read_text(encoding="utf-8"), re.MULTILINE)
        assert not switched, f"{file}: {switched}"


def test_global_names_are_unique():
    """No two files that a shader may include together define the same name.

    Alternatives, such as methods, may share names.
    """
    homes = defaultdict(set)
    for file in FILES:
        for name in global_names(file.read_text(encoding="utf-8")):
            homes[name].add(home(file))
    shared = {name: sorted(places) for name, places in homes.items() if len(places) > 1}
    assert not shared


def test_nothing_is_named_as_a_block_is():
    """Blender 4.5 turns a block's name into a macro, which would replace any field or variable of that name."""
    for file in FILES:
        plain = re.sub(r"//.*", "", file.read_text(encoding="utf-8"))
        taken = re.findall(r"\.(?:view|draw|frame)\b|\b\w+ (?:view|draw|frame)\s*[;,=)\[(]", plain)
        taken = [text for text in taken if not text.startswith("return ")]
        assert not taken, f"{file}: {taken}"


def test_a_function_for_a_hook_that_is_not_there_is_refused(tmp_path, monkeypatch):
    write(tmp_path, "hosts/small.frag", "#parts\nvoid main() {\n  #hook color(c)\n}\n")
    write(tmp_path, "features/tint", "#part small.frag\nvoid tint_colour(inout vec3 c) {}\n")
    use(tmp_path, monkeypatch)
    with pytest.raises(ValueError, match=r"tint_colour for the host small.frag, whose hooks are color"):
        compose("small.frag", ("tint",))


def test_features_act_at_hooks_in_their_order_and_where_all_words_hold(tmp_path, monkeypatch):
    write(tmp_path, "hosts/small.frag", '#include "lib/{kind}.glsl"\n#parts\nvoid main() {\n  #hook add(c)\n}\n')
    write(tmp_path, "lib/plain", "float plain;\n")
    write(tmp_path, "features/a", "float shared;\n#part small.frag, b\nvoid a_add(vec3 c) {}\n")
    write(tmp_path, "features/b", "#part small.frag\nvoid b_add(vec3 c) {}\nfloat helper(float x) {}\n")
    use(tmp_path, monkeypatch)
    kind = (("kind", "plain"),)
    both = compose("small.frag", ("a", "b"), kind)
    assert both.index("float plain") < both.index("float shared") < both.index("void a_add") < both.index("void b_add")
    assert "  a_add(c);\n  b_add(c);\n}" in both
    assert "  b_add(c);\n  a_add(c);\n}" in compose("small.frag", ("b", "a"), kind)
    assert "shared" not in compose("small.frag", ("a",), kind)
    assert "#" not in compose("small.frag", (), kind)


def test_a_composed_text_says_where_its_parts_are_from():
    chosen = ("depth_format", "linear"), ("instances", "uniform")
    text = compose("visibility.frag", ("object_id", "moved_back"), chosen, origins=True)
    opened, closed = (re.findall(rf"^// {mark} (.*)$", text, re.MULTILINE) for mark in (">>>", "<<<"))
    assert sorted(opened) == sorted(closed) == [
        "depth_formats/linear.glsl", "features/object_id.glsl", "hosts/visibility.frag.glsl",
        "lib/instances/uniform.glsl",
    ]  # fmt: skip


def test_a_pass_is_printed_by_its_name_with_the_origin_of_its_parts(capsys):
    scene = ["--scene", "splat_addon.reference.scenes:textured_plane", "--set", "method=quad", "lines=Lines()"]
    main(["attributes", *scene, "--variant", "textured"])
    printed = capsys.readouterr().out
    assert "==== attributes (opaque): object_space.frag" in printed
    for part in ("features/gbuffer", "features/textures", "methods/quad", "lib/texture_lookup"):
        assert f"// >>> {part}.glsl" in printed
    main(["shading", *scene])
    assert "lines_finish(s);" in capsys.readouterr().out
    with pytest.raises(SystemExit, match=r"no pass hiz .* visibility, attributes, lines, shading"):
        main(["hiz", *scene])


@pytest.fixture(autouse=True)
def nothing_is_remembered():
    yield
    forget()


def forget():
    for remembered in (composing._read, composing._exists, compose):
        remembered.cache_clear()


def write(folder, name, text):
    path = folder / f"{name}.glsl"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text, encoding="utf-8")


def use(folder, monkeypatch):
    """Compose from that folder, with an empty cache."""
    monkeypatch.setattr(composing, "FOLDER", folder)
    forget()
