# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports a model file as mesh objects with Blender's own importers, and converts these to surfels.

Gzipped files are unpacked first.
"""

from __future__ import annotations

import gzip
import re
import shutil
import tempfile
import time
import urllib.parse
import zlib
from pathlib import Path

from environment import Problem

#: suffix -> the operator `bpy.ops.MODULE.NAME` that reads it, and its options.
IMPORTERS = {
    ".obj": ("wm", "obj_import", {}),
    # Scanners write PLY with Y up, but the file does not say so.
    ".ply": ("wm", "ply_import", {"forward_axis": "NEGATIVE_Z", "up_axis": "Y"}),
    ".stl": ("wm", "stl_import", {}),
    ".glb": ("import_scene", "gltf", {}),
    ".gltf": ("import_scene", "gltf", {}),
}


def model_suffix(path: Path) -> str:
    """File type of a model, in lower case and without .gz."""
    name = path.name.lower()
    return Path(name[: -len(".gz")] if name.endswith(".gz") else name).suffix


def import_model(path: Path) -> list:
    """The mesh objects with faces in the file. Raises Problem if it cannot be read or has none."""
    import bpy

    module, name, options = IMPORTERS[model_suffix(path)]
    with tempfile.TemporaryDirectory() as folder:
        readable = unpack(path, Path(folder)) if path.name.lower().endswith(".gz") else path
        operator = getattr(getattr(bpy.ops, module), name)
        call(f"{path} cannot be read as {model_suffix(path)}", operator, filepath=str(readable), **options)
        _keep_images()
    meshes = [o for o in bpy.context.view_layer.objects if o.type == "MESH" and o.data.polygons and o.visible_get()]
    if not meshes:
        raise Problem(f"{path} holds no mesh with faces, and surfels are made from faces.")
    return meshes


def convert(meshes: list, **options) -> tuple[list, float]:
    """Convert `meshes` to surfel objects with the add-on's operator and its options; returns them and the time in
    seconds."""
    import bpy

    for one in bpy.context.view_layer.objects:
        one.select_set(one in meshes)
    bpy.context.view_layer.objects.active = meshes[0]
    before, started = set(bpy.data.objects), time.perf_counter()
    call("The conversion failed", bpy.ops.object.surfels_from_mesh, **options)
    seconds, made = time.perf_counter() - started, set(bpy.data.objects) - before
    surfels = [o for o in bpy.data.objects if o in made and {"rotation", "scale"} <= set(o.data.attributes.keys())]
    if not surfels:
        raise Problem("The conversion made no surfels: the model has no face with an area.")
    return surfels, seconds


def call(failure: str, operator, **options) -> None:
    """Call an operator, and turn its error report into a Problem."""
    try:
        operator(**options)
    except RuntimeError as error:
        raise Problem(f"{failure}: {_one_line(error)}.") from None


def unpack(path: Path, folder: Path) -> Path:
    """Unpack a .gz file into `folder`, and copy the files that it refers to (materials, textures, buffers)."""
    target = folder / path.name[: -len(".gz")]
    try:
        with gzip.open(path) as packed, target.open("wb") as plain:
            shutil.copyfileobj(packed, plain)
    except (gzip.BadGzipFile, EOFError, zlib.error) as error:
        raise Problem(f"{path} is not a whole gzip file: {_one_line(error)}.") from None
    _copy_named_files(target, path.parent, folder)
    return target


def _copy_named_files(text_file: Path, source: Path, folder: Path) -> None:
    """Copy the files that a file names from `source` to `folder`; a material library names textures in turn."""
    pattern = _NAMED_FILES.get(text_file.suffix.lower())
    text = text_file.read_text(encoding="utf-8", errors="replace") if pattern else ""
    for name in re.findall(pattern, text, re.MULTILINE) if pattern else ():
        name = urllib.parse.unquote(name) if text_file.suffix.lower() == ".gltf" else name
        original, copy = source / name, folder / name
        is_inside = folder.resolve() in copy.resolve().parents
        if is_inside and original.is_file() and not copy.exists():
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(original, copy)
            _copy_named_files(copy, source, folder)


#: suffix -> pattern with which such a file names another file.
_NAMED_FILES = {
    ".obj": r"^mtllib[ \t]+(\S.*?)\s*$",
    ".mtl": r"^\s*(?:map_\w+|bump|norm|refl)[ \t](?:.*[ \t])?(\S+)\s*$",
    ".gltf": r'"uri"\s*:\s*"(?!data:)([^"]+)"',
}


def _keep_images() -> None:
    """Pack all images into the .blend before the temporary folder is deleted."""
    import bpy

    for image in bpy.data.images:
        if image.source == "FILE" and image.has_data and not image.packed_file:
            image.pack()


def _one_line(error: Exception) -> str:
    return " ".join(str(error).replace("Error: ", "").split()).rstrip(".")
