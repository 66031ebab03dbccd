# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels convert`: converts objects of the file to surfels and saves a new file; or converts one block, for `surfels
merge`."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterator
from pathlib import Path

import bpy

from ...array_files import is_archive
from ...claims import claimed
from ...sampling import Sampling, sample_block, sample_surface, write_blocks
from ..conversion.batch import Batch, ConversionBatch
from ..conversion.mesh_conversion import sampling_options
from ..conversion.mesh_settings import choices
from ..conversion.ties import tie
from ..density_properties import DENSITIES
from ..geometry.sources import has_surfaces
from ..ids import CONVERSION_SETTINGS
from .out_paths import file_at, made_room
from .written_files import check_end_of_blend, save_blend

HELP = "make surfels of objects, in a new file"
DESCRIPTION = (
    "Converts objects with the settings of the file's sidebar, or those that are given here, and saves the result as a "
    "new file. The sources are left out of its renders. With --block, converts only that block and writes it beside "
    "the new file, for `merge`."
)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--out", required=True, help="the new .blend, or its FOLDER/")
    parser.add_argument("--objects", nargs="+", help="names; without them everything visible that has surfaces")
    add_density_arguments(parser)
    add_blocks_argument(parser)
    parser.add_argument("--block", type=int, help="the one block to convert, from 1; it waits beside --out")
    parser.add_argument("--again", action="store_true", help="convert even where the file is there already")


def add_blocks_argument(parser: argparse.ArgumentParser) -> None:
    """Add the argument that `merge` needs too."""
    parser.add_argument("--blocks", type=_block_count, help="how many blocks of the sampling grid machines share")


def _block_count(text: str) -> int:
    if not re.fullmatch("0*[1-9][0-9]*", text):
        raise argparse.ArgumentTypeError(f"the number of blocks is 1 or more, not {text!r}")
    return int(text)


#: argument that overrides the sidebar's density -> its type
_DENSITIES = {"resolution": int, "spacing": float, "count": int}


def refuse_density(options: argparse.Namespace) -> None:
    """Raise ValueError for a density where a file is given, whose points are what they are."""
    for name in _DENSITIES:
        if getattr(options, name) is not None:
            raise ValueError(f"--{name} is about objects and changes nothing of a file; leave it out, or name objects.")


def add_density_arguments(parser: argparse.ArgumentParser) -> None:
    """Add the arguments that override the sidebar's density."""
    density = parser.add_mutually_exclusive_group()
    for name, kind in _DENSITIES.items():
        density.add_argument(f"--{name}", type=kind, help=DENSITIES[name.upper()].description)


def run(options: argparse.Namespace) -> Iterator[Path]:
    """Convert, and yield the written file. Raises ValueError or OSError; nothing is saved if any object cannot be
    converted."""
    if (options.block is None) != (options.blocks is None):
        raise ValueError("A block needs both --block and --blocks.")
    out = result(options)
    file = out if options.block is None else block_file(out, options.block, options.blocks)
    with claimed(made_room(file)):
        if not options.again and (there := _there_already(file, out)):
            print(f"there already: {there}", flush=True)
            return
        sources = sources_of(options.objects)
        batch = batch_of(sources, options)
        if options.block is None:
            for conversion in batch.prepared(bpy.context):
                batch.sample(conversion)
            place(batch, settings_of(options))
            save_blend(out)
        else:
            _write_block(batch, file, options, request_of(sources, options))
        yield file


def _there_already(file: Path, out: Path) -> Path | None:
    """What an earlier run made of a conversion or of one of its blocks. Raises ValueError as `is_blend_there`."""
    if is_blend_there(out):
        return out
    return file if file != out and is_archive(file) else None


def _write_block(batch: ConversionBatch, file: Path, options: argparse.Namespace, request: dict) -> None:
    blocks = [
        sample_block(conversion.mesh, options.block - 1, options.blocks, **sampling_options(conversion))
        for conversion in batch.prepared(bpy.context)
    ]
    refuse(batch)
    write_blocks(file, blocks, request)


def request_of(sources: list[bpy.types.Object], options: argparse.Namespace) -> dict:
    """What `merge` needs to know of a conversion in blocks: its options, and in `names` the objects that they meant."""
    given = {name: getattr(options, name) for name in ("objects", *_DENSITIES)}
    return {**given, "names": [each.name for each in sources]}


def is_request(values: dict) -> bool:
    """Whether values from a file are what `request_of` makes."""
    lists = [values.get("names"), *([values["objects"]] if values.get("objects") is not None else [])]
    numbers = [(kind, values[name]) for name, kind in _DENSITIES.items() if values.get(name) is not None]
    return (
        values.keys() == {"objects", "names", *_DENSITIES}
        and all(isinstance(names, list) and all(isinstance(name, str) for name in names) for names in lists)
        and all(type(value) is kind and abs(value) < 2**31 for kind, value in numbers)
    )


def result(options: argparse.Namespace) -> Path:
    """The path of the result; in a folder it is called after the .blend. Raises ValueError if it is not a .blend."""
    return file_at(options.out, ".blend", f"{Path(bpy.data.filepath).stem}-surfels")


def block_file(out: Path, number: int, count: int) -> Path:
    """The file of one block. number: from 1."""
    return out.with_name(f"{out.name}.block-{number}-of-{count}.npz")


def batch_of(
    sources: list[bpy.types.Object], options: argparse.Namespace, sampler: Callable[..., Sampling] = sample_surface
) -> ConversionBatch:
    """A batch of these sources with the chosen settings. sampler: replaces `sample_surface`, with the same
    arguments."""
    return ConversionBatch(sources, choices(settings_of(options)), bpy.context.view_layer.objects.active, sampler)


def settings_of(options: argparse.Namespace):
    """The settings stored in the file, overridden by the command's arguments."""
    settings = getattr(bpy.context.scene, CONVERSION_SETTINGS)
    for name in _DENSITIES:
        if getattr(options, name) is not None:
            settings.density = name.upper()
            setattr(settings, name, getattr(options, name))
    return settings


def sources_of(names: list[str] | None) -> list[bpy.types.Object]:
    """The objects to convert. Raises ValueError for a name that does not exist or an object without a surface."""
    if not names:
        found = [each for each in bpy.context.view_layer.objects if each.visible_get() and has_surfaces(each)]
        if not found:
            raise ValueError("Nothing visible has surfaces to convert; name objects with --objects.")
        return found
    return named(names, has_surfaces, "no surface to convert, or is surfels already")


def named(names: list[str], can: Callable[[bpy.types.Object], bool], lacks: str) -> list[bpy.types.Object]:
    """The objects of these names. Raises ValueError for a name that does not exist, and for an object for which `can`
    is false; lacks: what such an object has."""
    missing = [name for name in names if name not in bpy.context.scene.objects]
    if missing:
        raise ValueError(f"The scene has no object {missing[0]!r}.")
    found = [bpy.context.scene.objects[name] for name in names]
    if unfit := [each.name for each in found if not can(each)]:
        raise ValueError(f"The object {unfit[0]!r} has {lacks}.")
    return found


def refuse(batch: Batch) -> None:
    """Raise ValueError if any object cannot be converted."""
    if batch.refused:
        raise ValueError(" ".join(f"{name}: {sentence}" for name, sentence in batch.refused))


def place(batch: Batch, settings, kind: str = "MESH") -> None:
    """Add the surfel objects, tied to their hidden sources; kind, settings: of their record. Raises ValueError if any
    object was refused."""
    refuse(batch)
    for conversion, made in batch.place_all(bpy.context):
        print(f"{conversion.name}: {conversion.summary()}", flush=True)
        for note in conversion.notes:
            print(f"{conversion.name}: {note}", flush=True)
        follows = kind != "MESH" or settings.follow
        for note in tie(conversion, made, kind, settings, follows, hides=True):
            print(note, flush=True)


def is_blend_there(out: Path) -> bool:
    """Whether there is a .blend that an earlier run made. Raises ValueError for one that is not whole, which is not
    replaced, because it may be somebody's."""
    try:
        return out.is_file() and not check_end_of_blend(out)
    except ValueError as error:
        raise ValueError(f"{out} is there, but it is not whole: {error} Delete it, and run this again.") from error
