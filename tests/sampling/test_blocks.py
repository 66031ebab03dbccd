# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh that several machines sample in blocks of the grid has the same surfels, bit by bit, as on one machine."""

import math
import tracemalloc
import zipfile
from dataclasses import replace

import numpy as np
import pytest

from splat_addon.sampling import (
    Channel,
    Image,
    Surface,
    Texture,
    Tolerance,
    TriangleMesh,
    read_block,
    read_request,
    write_blocks,
)
from tests.plain import joined_blocks, sample_block, sample_surface


@pytest.fixture(scope="module")
def rubble():
    """2,000 random triangles from slivers to plates, with shading normals and colours, and dust between the rays."""
    random = np.random.default_rng(5)
    middles, sizes = random.uniform(-1, 1, (2000, 1, 3)), 10 ** random.uniform(-3, -0.3, (2000, 1, 1))
    corners = middles * (1, 1, 0.3) + sizes * random.normal(size=(2000, 3, 3))
    normals = random.normal(size=(2000, 3, 3))
    return TriangleMesh(
        positions=corners.reshape(-1, 3),
        triangles=np.arange(6000).reshape(-1, 3),
        corner_normals=normals / np.linalg.norm(normals, axis=2, keepdims=True),
        corner_colors=random.uniform(size=(2000, 3, 4)),
        materials=random.integers(0, 1, 2000),
    )


OPTIONS = {
    "plain": {"resolution": 90},
    "merged": {"resolution": 60, "reduction": "three_to_one"},
    "by own normals": {"resolution": 60, "reduction": "surfel_normal"},
    "adaptive": {"resolution": 60, "tolerance": Tolerance(0.01)},
    "clipped": {"resolution": 40, "crease_angle": math.radians(30), "fits_blending": True, "fits_planes": True},
}


@pytest.mark.parametrize("count", [1, 7])
@pytest.mark.parametrize("name", OPTIONS)
def test_blocks_are_one_run_bit_by_bit(name, count, rubble, tmp_path):
    whole = sample_surface(rubble, **OPTIONS[name])
    files = [tmp_path / str(number) for number in range(count)]
    for number, file in enumerate(files):
        write_blocks(file, [sample_block(rubble, number, count, **OPTIONS[name])])
    blocks = [read_block(file) for file in reversed(files)]
    joined = joined_blocks(rubble, blocks, **OPTIONS[name])
    assert len(whole.surfels) > 1000 and whole.small_parts > 10
    assert (joined.small_parts, joined.saved, joined.error) == (whole.small_parts, whole.saved, whole.error)
    mine, other = joined.surfels.arrays(), whole.surfels.arrays()
    assert mine.keys() == other.keys()
    for field in mine:
        assert mine[field].tobytes() == other[field].tobytes(), field
    if count > 1 and name == "plain":
        sizes = [len(block.arrays["positions"]) for block in blocks]
        assert min(sizes) > 0 and sum(sizes) + whole.small_parts == len(whole.surfels)


def test_a_mesh_without_usable_triangles_has_no_surfels_in_blocks_either():
    mesh = TriangleMesh(positions=np.zeros((3, 3)), triangles=np.array([[0, 1, 2]]))
    blocks = [sample_block(mesh, number, 2, spacing=1.0) for number in range(2)]
    assert len(joined_blocks(mesh, blocks, spacing=1.0).surfels) == 0


def test_blocks_that_do_not_belong_together_are_refused(rubble):
    first, second = (sample_block(rubble, number, 2, resolution=20) for number in range(2))
    with pytest.raises(ValueError, match="must be given once, but these were given: 2"):
        joined_blocks(rubble, [second], resolution=20)
    with pytest.raises(ValueError, match="other settings"):
        joined_blocks(rubble, [first, second], resolution=21)
    with pytest.raises(ValueError, match="another mesh"):
        joined_blocks(replace(rubble, positions=rubble.positions + 1), [first, second], resolution=20)
    with pytest.raises(ValueError, match="no block 3 of 2"):
        sample_block(rubble, 2, 2, resolution=20)


def test_blocks_of_other_materials_are_refused(rubble):
    def painted(color=0.5, pixel=0.5, extension="REPEAT"):
        image = Image(np.full((2, 2, 4), pixel, np.float32), extension)
        channel = Channel((color, 0.5, 0.5, 1.0), Texture(image))
        uvs = np.zeros((len(rubble), 3, 2))
        return replace(rubble, corner_uvs=uvs, surfaces=(Surface(channel), Surface(roughness=Channel((0.1,)))))

    blocks = [sample_block(painted(), number, 2, resolution=20) for number in range(2)]
    assert len(joined_blocks(painted(), blocks, resolution=20).surfels) > 1000
    for edited in (painted(color=0.4), painted(pixel=0.4), painted(extension="CLIP")):
        with pytest.raises(ValueError, match="other materials"):
            joined_blocks(edited, blocks, resolution=20)


def test_a_request_goes_with_the_blocks(tmp_path):
    request = {"objects": ["K\u00e4fer"], "spacing": 0.1}
    write_blocks(tmp_path / "block", [], request)
    assert read_request(tmp_path / "block") == request
    with pytest.raises(ValueError, match="is not a file of blocks"):
        read_block(tmp_path / "block")


def _peak(made) -> int:
    """Most bytes that a call holds at once."""
    tracemalloc.start()
    try:
        made()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def test_joining_reads_one_mesh_and_holds_its_samples_once(rubble, tmp_path):
    """Large splats are few here, so that nearly all bytes are of the samples' fields."""
    options, files = {"resolution": 300}, [tmp_path / str(number) for number in range(3)]
    for number, file in enumerate(files):
        write_blocks(file, [sample_block(rubble, number, 3, **options)] * 4)
    surfels = sample_surface(rubble, **options).surfels
    samples = sum(array.nbytes for array in surfels.arrays().values())
    assert 4 * samples < sum(file.stat().st_size for file in files)
    joined = _peak(lambda: joined_blocks(rubble, (read_block(file, 2) for file in files), **options))
    assert joined < 1.2 * _peak(lambda: sample_surface(rubble, **options))
    assert _peak(lambda: read_block(files[1], 2)) < 0.2 * samples


def test_samples_that_are_damaged_are_named_when_they_are_read(rubble, tmp_path):
    file = tmp_path / "block"
    write_blocks(file, [sample_block(rubble, 0, 1, resolution=20)])
    with zipfile.ZipFile(file) as archive:
        start = archive.getinfo("0.surfels.positions.npy").header_offset
    content = bytearray(file.read_bytes())
    content[start + 500] ^= 1
    file.write_bytes(content)
    with pytest.raises(ValueError, match="block is damaged or is not a file of blocks; convert the block again"):
        joined_blocks(rubble, [read_block(file)], resolution=20)


def _text(file):
    file.write_text("no archive at all")


def _cut(file):
    file.write_bytes(file.read_bytes()[:-100])


def _one_array(file):
    with open(file, "wb") as stream:
        np.save(stream, np.arange(3))


def _no_json(file):
    with open(file, "wb") as stream:
        np.savez(stream, **{"request": np.frombuffer(b"{", np.uint8), "0.about": np.arange(3)})


def _says(name, head, numbers=bytes(64), packing=zipfile.ZIP_STORED):
    """Give an array another header, and other numbers."""

    def damage(file):
        with zipfile.ZipFile(file) as archive:
            members = {member: archive.read(member) for member in archive.namelist()}
        members[name] = b"\x93NUMPY\x01\x00" + (len(head) + 1).to_bytes(2, "little") + head + b"\n" + numbers
        with zipfile.ZipFile(file, "w", packing) as archive:
            for member, data in members.items():
                archive.writestr(member, data)

    return damage


def _head(kind, *shape):
    return repr({"descr": kind, "fortran_order": False, "shape": shape}).encode()


@pytest.mark.parametrize(
    "damage",
    [
        _says("0.made_from.npy", _head("|O", 4)),
        _says("0.made_from.npy", _head("<U8", 2)),
        _says("0.made_from.npy", _head("|u1", 32), bytes(32), zipfile.ZIP_DEFLATED),
        _says("0.1.0.rows.npy", _head("<i4", 1 << 40)),
        _says("0.1.0.rows.npy", _head("<i4", -1)),
        _says("0.1.0.counts.npy", _head("<i4", 16)),
        _says("0.about.npy", _head("<i8", 2), np.array([5, 2]).tobytes()),
    ],
)
def test_types_and_counts_of_a_file_are_not_believed(damage, rubble, tmp_path):
    file = tmp_path / "block"
    write_blocks(file, [sample_block(rubble, 0, 2, resolution=5)])
    damage(file)
    tracemalloc.start()
    with pytest.raises(ValueError, match="is damaged or is not a file of blocks"):
        read_block(file)
    assert tracemalloc.get_traced_memory()[1] < 10e6
    tracemalloc.stop()


@pytest.mark.parametrize(("name", "value"), [("triangles", 2000), ("rows", 21), ("columns", -1)])
def test_samples_beside_the_mesh_are_refused(name, value, rubble):
    block = sample_block(rubble, 0, 1, resolution=20)
    getattr(block.images[1], name)[3] = value
    with pytest.raises(ValueError, match="Block 1 is damaged: its samples do not fit the mesh; convert it again"):
        joined_blocks(rubble, [block], resolution=20)


@pytest.mark.parametrize("damage", [_text, _cut, _one_array, _no_json])
@pytest.mark.parametrize("read", [read_block, read_request])
def test_a_damaged_file_is_named(damage, read, rubble, tmp_path):
    file = tmp_path / "block"
    write_blocks(file, [sample_block(rubble, 0, 2, resolution=5)])
    damage(file)
    with pytest.raises(ValueError) as refused:
        read(file)
    assert str(refused.value) == f"{file} is damaged or is not a file of blocks; convert the block again."


def test_a_file_that_is_not_there_is_an_error_of_the_system(tmp_path):
    with pytest.raises(FileNotFoundError):
        read_block(tmp_path / "nowhere")
