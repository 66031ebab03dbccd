# SPDX-License-Identifier: GPL-3.0-or-later
"""Changes in newer Blenders are found by testing for the feature, so that unknown versions work too."""

import re
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

from splat_addon import blender
from splat_addon.blender.engine.render_passes import RENDER_PASSES
from splat_addon.blender.materials.node_trees import has_switch, uses_nodes

#: Random numbers of textures changed, and nothing but the version tells.
_WITHOUT_A_FEATURE = "bpy.app.version >= _PCG"


def test_no_version_is_compared():
    sources = Path(blender.__file__).parent.rglob("*.py")
    compared = [f"{p.name}: {line}" for p in sources for line in p.read_text().splitlines()
                if re.search(r"app\.version(?!_string)", line) and _WITHOUT_A_FEATURE not in line]  # fmt: skip
    assert compared == []


def owner(**switch):
    """A stand-in for a material, with a node tree and its switch off, in an old or a new Blender."""
    properties = {"use_nodes": SimpleNamespace(**switch)} if switch else {}
    return SimpleNamespace(bl_rna=SimpleNamespace(properties=properties), node_tree="nodes", use_nodes=False)


def test_a_switch_that_blender_gives_up_is_not_asked():
    assert has_switch(owner(name="Use Nodes")) and not uses_nodes(owner(name="Use Nodes"))
    assert has_switch(owner(is_deprecated=False)) and not uses_nodes(owner(is_deprecated=False))
    for newer in (owner(is_deprecated=True), owner()):
        assert not has_switch(newer) and uses_nodes(newer)
        del newer.use_nodes
        assert uses_nodes(newer)


@pytest.mark.parametrize("collection", ["materials", "worlds"])
def test_a_new_data_block_uses_its_nodes_where_there_is_no_switch(collection):
    made = getattr(bpy.data, collection).new("new")
    assert uses_nodes(made) == (not has_switch(made))


def test_passes_have_the_names_that_this_blender_s_own_engine_gives_them():
    """The names are those of EEVEE, which a Render Layers node lists."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    scene.render.engine = "BLENDER_EEVEE" if "BLENDER_EEVEE" in _engines() else "BLENDER_EEVEE_NEXT"
    ours = [p for p in RENDER_PASSES if p.flag and not p.is_ours and hasattr(view_layer, p.flag)]
    for p in ours:
        setattr(view_layer, p.flag, True)
    listed = {socket.name for socket in _layers_node(scene).outputs}
    known = {p.name for p in ours} - {"Object Index", "IndexOB", "Material Index", "IndexMA"}  # EEVEE has none
    assert known and known <= listed


def _engines():
    return bpy.types.RenderSettings.bl_rna.properties["engine"].enum_items.keys()


def _layers_node(scene):
    if hasattr(scene, "compositing_node_group"):
        tree = scene.compositing_node_group = bpy.data.node_groups.new("compositing", "CompositorNodeTree")
    else:
        scene.use_nodes = True
        tree = scene.node_tree
    node = tree.nodes.new("CompositorNodeRLayers")
    node.scene = scene
    return node
