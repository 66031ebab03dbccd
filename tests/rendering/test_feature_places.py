# SPDX-License-Identifier: GPL-3.0-or-later
"""A feature's code is in its module and GLSL file; every other file that names it is listed here with a reason.

A Python file names a feature if it imports its module, gives `Part` the name of one of its files, or looks up its
results (`facts`, `has`). A GLSL file names it if it has a section for it, samples one of its textures, or reads one of
its values or constants.
"""

import ast
import re
from collections import defaultdict
from pathlib import Path

from splat_addon.rendering import features
from splat_addon.rendering.features import FEATURES, name_of
from splat_addon.rendering.plan.compose import FOLDER
from splat_addon.rendering.plan.graph import Texture

RENDERING = Path(features.__file__).parents[1]
#: name of a file in shaders/features -> its feature
FILES = {name: name_of(f) for f in FEATURES for name in (name_of(f), *getattr(f, "NAMES", ()))}

#: feature -> ((reason, the files that name it), ...). No other file may name it.
MEETINGS = {
    "back_culling": (("a frame tells how many splats were left out", "statistics.py"),),
    "blend_depth": (
        ("splats that blend so little tell joined sheets apart by their depths", "features/silhouettes.glsl"),
    ),
    "clip_lines": (("creases have two faces where splats end at them", "features/folds.py"),),
    "depth_bounds": (
        ("a level of its depths, coarser", "features/hiz.py hosts/hiz.frag.glsl"),
        ("of layers, whose depths are compared as those of the opaque are", "features/transparency.py"),
        ("depths of methods that work in the picture are compared with its own",
         "features/visibility.glsl features/polygons.glsl features/lines.glsl features/clip_lines.glsl "
         "features/silhouettes.glsl"),
        ("a filter tells by them where it has nothing to do", "features/lighting.py hosts/resolve.frag.glsl"),
    ),
    "depth_format": (
        ("passes that draw splats or polygons write depth where it is linear",
         "features/gbuffer.py features/polygons.py features/visibility.py plan/build.py"),
        ("the extent of depths tells whether any splat is so near", "features/near_clipped.py"),
        ("it shows depth between the ends of that range", "shading_models/depth.glsl"),
    ),
    "finish": (
        ("its shares are stored beside a material", "features/materials.py"),
        ("polygons have a finish too", "features/polygons.py"),
        ("principled shading looks at the finishes and a table", "lib/finish.glsl lib/brdf.glsl"),
    ),
    "gbuffer": (
        ("the mean of a splat's attributes is what is lit, looked at for lines and occlusion",
         "hosts/mean_surface.glsl hosts/lines.frag.glsl features/ambient_occlusion.py lib/faces/several.glsl"),
        ("layers have sums as the opaque picture has",
         "features/transparency.py features/transparency.glsl features/oit.py hosts/oit_shading.frag.glsl"),
        ("planes that shadows compare depths with lie beside its depths", "features/shadows.py features/shadows.glsl"),
        ("sums of float16 are scaled", "sum_formats/float16.glsl"),
        ("its sums leave room for those of finishes, or do not", "features/finish.py"),
    ),
    "hidden_objects": (
        ("they are found while visibility draws, in a picture and in shadow maps",
         "features/visibility.py features/shadows.py"),
    ),
    "levels": (
        ("each view draws its own cut", "plan/cut_choice.py plan/together.py"),
        ("single blocks of an object with levels may be hidden", "features/hidden_objects.py"),
        ("levels have merged surfels, which have a size of their own", "features/merged_size.py"),
    ),
    "lighting": (
        ("a layer is lit as the opaque picture is, and its lit samples put into pixels",
         "features/transparency.py features/oit.py hosts/oit_layer.frag.glsl hosts/peel_oit.frag.glsl "
         "lib/layer_at.glsl features/silhouettes.glsl"),
    ),
    "lights": (
        ("models add up what each light sends",
         "hosts/lights.glsl shading_models/phong.glsl shading_models/principled.glsl shading_models/ramp.glsl "
         "shading_models/toon.glsl"),
        ("a light tells which maps are its own", "features/shadows.glsl"),
        ("polygons are of a set of objects too", "features/polygons.py"),
        ("its sums leave room for those of finishes, or do not", "features/finish.py"),
    ),
    "lit_splats": (
        ("splats are lit before they are added up", "features/gbuffer.py features/oit.py features/oit.glsl"),
        ("of what is lit one by one nothing is merged", "features/levels.py"),
        ("samples show the colours that are lit, as flat shading does", "plan/build.py"),
        ("planes are summed where samples are lit", "features/shadows.py"),
        ("normals change where samples are lit", "features/normal_fields.py"),
    ),
    "materials": (
        ("the one material of all is there where none differ", "hosts/lit_splats.frag.glsl hosts/shaded_sample.glsl"),
        ("polygons have materials too", "features/polygons.py features/polygon_material.glsl"),
        ("a finish is stored beside them", "features/finish.py"),
    ),
    "object_id": (("indices and mattes are made of the numbers that are read back", "identity.py renderer.py"),),
    "oit": (("the last layer", "features/transparency.py"),),
    "outputs": (
        ("they write pixels", "features/lighting.py features/transparency.py features/world.py"),
        ("splats are counted beside planes", "features/shadows.py"),
        ("its sums leave room for those of finishes, or do not", "features/finish.py"),
        ("the picture is added up", "features/sample_sum.py hosts/accumulate.frag.glsl"),
        ("pixels become the arrays of a frame", "renderer.py"),
    ),
    "textures": (
        ("polygons with holes are looked up in textures by their planes too", "features/cut_outs.py"),
        ("normal maps lie in the atlas of textures and are filtered as they are",
         "features/normal_maps.py features/normal_maps.glsl lib/uv_gradient.glsl"),
    ),
    "polygons": (
        ("of a sample that is a polygon's too, an attribute is mixed with the polygon's",
         "features/emission.glsl features/finish.glsl features/light_links.glsl features/lit_splats.glsl "
         "features/materials.glsl features/shadows.glsl"),
        ("they occlude", "features/ambient_occlusion.py"),
        ("textures and normal maps are looked up by their planes", "features/textures.py features/normal_maps.py"),
    ),
    "sample_sum": (("a view that refines shows it", "renderer.py"),),
    "shadows": (
        ("splats are counted beside its planes", "features/outputs.py features/overdraw.glsl"),
        ("lights come with their maps", "features/lights.py"),
        ("planes of polygons keep these from shadowing themselves", "features/polygons.py"),
        ("planes of splats lie beside their depths", "features/gbuffer.py"),
        ("maps are made with holes", "features/transparent_shadows.py"),
        ("what they see is found once for all samples", "plan/shared.py"),
    ),
    "silhouettes": (
        ("what is seen between rows of samples tells where a silhouette lies",
         "features/visibility.py features/depth_bounds.py features/holdout.py features/object_id.py"),
        ("all rows of a sample have holes by one threshold", "features/cut_outs.py"),
        ("pixels are filtered over silhouettes, and so are mattes",
         "features/lighting.py hosts/resolve.frag.glsl identity.py"),
        ("they are blurred where a clipped splat ends before another surface", "features/clip_lines.glsl"),
    ),
    "transparency": (
        ("outputs of layers are handed on", "features/outputs.py"),
        ("what layers hide is known at samples alone", "features/silhouettes.py"),
        ("transparent surfels alone cast such shadows", "features/transparent_shadows.py"),
        ("hosts of its passes, and what they read of how far is peeled",
         "hosts/layer.frag.glsl hosts/peel_oit.frag.glsl lib/peel_state.glsl"),
    ),
    "visibility": (
        ("its depth is tested with",
         "features/gbuffer.py features/depth_bounds.py features/lighting.py features/transparency.py "
         "features/transparency.glsl features/oit.glsl lib/layer_sample.glsl features/object_id.py"),
        ("what finds what is nearest is drawn by its pass", "features/shadows.py features/object_id.glsl"),
        ("what is seen and has no sums is a hole", "features/holdout.py lib/hole.glsl"),
    ),
    "world": (
        ("a picture of nothing but the world refines too", "features/sample_sum.py"),
        ("a world that is a picture is drawn where nothing else is", "plan/tile.py"),
    ),
}  # fmt: skip


def test_a_feature_is_named_where_it_lives_and_where_a_meeting_is_declared():
    declared = {
        feature: {file for _, files in meetings for file in files.split()} for feature, meetings in MEETINGS.items()
    }
    found = places()
    for feature in {*declared, *found}:
        at, known = found.get(feature, set()), declared.get(feature, set())
        assert not at - known, f"{sorted(at - known)} name {feature}: declare the meeting, or do without it."
        assert not known - at, f"{sorted(known - at)} do not name {feature} any more."


def places() -> dict[str, set[str]]:
    """feature -> other files that name it, relative to rendering/ and shaders/."""
    found = defaultdict(set)
    owners = _owners()
    trees = {file: ast.parse(file.read_text(encoding="utf-8")) for file in sorted(RENDERING.rglob("*.py"))}
    facts, hosts, folders = _facts(trees), _hosts(trees), _folders(trees)
    for file, tree in trees.items():
        if file == Path(features.__file__):  # the order
            continue
        for feature in _named_in_python(file, tree, facts):
            found[feature].add(file.relative_to(RENDERING).as_posix())
    for file in sorted(FOLDER.rglob("*.glsl")):
        for feature in _named_in_glsl(file.read_text(encoding="utf-8"), owners):
            found[feature].add(file.relative_to(FOLDER).as_posix())
    for feature, files in found.items():
        files.discard(f"features/{feature}.py")
        files -= _own_texts(feature, hosts[feature], folders[feature])
    return {feature: files for feature, files in found.items() if files}


def _own_texts(feature: str, hosts: set[str], folders: set[str]) -> set[str]:
    """The GLSL files of a feature: its sections, its passes' hosts, folders it chooses from, and files only these
    include.
    """
    own = {f"features/{name}.glsl" for name, of in FILES.items() if of == feature}
    own |= {f"hosts/{host}.glsl" for host in hosts}
    own |= {f.relative_to(FOLDER).as_posix() for folder in folders for f in (FOLDER / "lib" / folder).glob("*.glsl")}
    includers = defaultdict(set)
    for file in FOLDER.rglob("*.glsl"):
        for path in re.findall(r'^#include "([^"{]+)"', file.read_text(encoding="utf-8"), re.MULTILINE):
            includers[path].add(file.relative_to(FOLDER).as_posix())
    while more := {path for path, by in includers.items() if path not in own and by <= own}:
        own |= more
    return own


def _owners() -> dict[str, str]:
    """The name of a texture, value, input or constant in shaders -> its feature."""
    owners = {}
    for feature in FEATURES:
        name = name_of(feature)
        for value in vars(feature).values():
            listed = value.values() if isinstance(value, dict) else [value]
            owners |= {t.name: name for t in listed if isinstance(t, Texture) and t.name not in owners}
    for feature in FEATURES:
        name = name_of(feature)
        owners |= {f"frame.{value}": name for value in getattr(feature, "VALUES", ())}
        owners |= dict.fromkeys((*getattr(feature, "INPUTS", ()), *getattr(feature, "CONSTANTS", ())), name)
    return owners


def _facts(trees) -> dict[str, str]:
    """The name of what a feature stores for its passes or reports about itself -> the feature."""
    facts = {}
    for file, tree in trees.items():
        if file.parent.name != "features":
            continue
        for node in ast.walk(tree):
            if isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store) and _is_facts(node.value):
                facts[node.slice.value] = file.stem
            if isinstance(node, ast.Call) and _called(node) in ("has", "counts"):
                if isinstance(node.args[0], ast.Constant):
                    facts[node.args[0].value] = file.stem
    return facts


def _hosts(trees) -> dict[str, set[str]]:
    """feature -> the hosts of its own passes."""
    hosts = defaultdict(set)
    for file, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and _called(node) == "Pass" and file.parent.name == "features":
                if isinstance(node.args[2], ast.Constant):
                    hosts[file.stem].add(node.args[2].value)
    return hosts


def _folders(trees) -> dict[str, set[str]]:
    """feature -> the folders from which its parts choose a file."""
    folders = defaultdict(set)
    for file, tree in trees.items():
        for node in ast.walk(tree):
            if isinstance(node, ast.Call) and _called(node) == "Part":
                for keyword in node.keywords:
                    if keyword.arg == "choices":
                        folders[file.stem] |= {choice.elts[0].value for choice in keyword.value.elts}
    return folders


def _named_in_python(file: Path, tree: ast.Module, facts: dict[str, str]):
    folder = file.relative_to(RENDERING).parent.parts
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            module = (*folder[: len(folder) - node.level + 1], *(node.module.split(".") if node.module else ()))
            if module == ("features",):
                yield from (alias.name for alias in node.names if alias.name in FILES.values())
            elif module[:1] == ("features",) and module[1] in FILES.values():
                yield module[1]
        elif isinstance(node, ast.Call) and _called(node) in ("Part", "has") and node.args:
            known = FILES if _called(node) == "Part" else facts
            if isinstance(node.args[0], ast.Constant) and node.args[0].value in known:
                yield known[node.args[0].value]
        elif isinstance(node, ast.Subscript) and _is_facts(node.value) and isinstance(node.slice, ast.Constant):
            yield from filter(None, [facts.get(node.slice.value)])
        elif isinstance(node, ast.Call) and _called(node) == "get" and _is_facts(getattr(node.func, "value", None)):
            yield from filter(None, [facts.get(node.args[0].value)])


def _is_facts(node) -> bool:
    return isinstance(node, ast.Attribute) and node.attr == "facts"


def _called(node: ast.Call) -> str:
    return getattr(node.func, "attr", getattr(node.func, "id", ""))


def _named_in_glsl(text: str, owners: dict[str, str]):
    for words in re.findall(r"^#part (.+)$", text, re.MULTILINE):
        yield from (FILES[word] for word in re.split(r"[ ,]+", words)[1:] if word in FILES)
    code = re.sub(r"//.*|^#.*", "", text, flags=re.MULTILINE)
    used = set(re.findall(r"\bframe\.\w+|\b[A-Z][A-Z0-9_]+\b", code))
    used |= set(re.findall(r"(?:texelFetch|textureSize|SUM_AT|SIZE_OF)\((\w+)", code))
    yield from (owners[word] for word in used if word in owners)
