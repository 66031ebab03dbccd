# SPDX-License-Identifier: GPL-3.0-or-later
"""Parts of a picture are joined exactly; a part that says something impossible of itself is refused."""

import io
import json
import zipfile

import numpy as np
import pytest

from splat_addon.rendering import Frame
from splat_addon.rendering.assembly.frame_parts import Part, joined_parts, write_part
from splat_addon.rendering.cryptomatte import Cryptomatte

SIZE, KEY = (8, 3), ("Layer", "left")


@pytest.fixture
def parts(tmp_path):
    """The paths of both halves of a picture."""
    paths = [tmp_path / "0.npz", tmp_path / "1.npz"]
    for number, path in enumerate(paths):
        matte = Cryptomatte((4, 3), np.arange(12, dtype=np.uint64) << np.uint64(32), np.ones(12), {"a": 7})
        color, depth = np.full((3, 4, 4), number + 0.5, np.float32), np.full((3, 4), np.inf, np.float32)
        frame = Frame(color=color, depth=depth, cryptomatte=matte)
        write_part(path, Part(SIZE, (4 * number, 0, 4, 3), 1), {KEY: frame})
    return paths


def test_parts_are_joined_exactly(parts):
    frame = joined_parts(parts, SIZE, 1)[KEY]
    assert (frame.color[:, :4] == 0.5).all() and (frame.color[:, 4:] == 1.5).all() and np.isinf(frame.depth).all()
    assert len(frame.cryptomatte.keys) == 24 and frame.cryptomatte.names == {"a": 7}


def rewritten(path, name, change):
    """Put another array into a part: numpy's own writer, without the limits of the reader."""
    with zipfile.ZipFile(path) as archive:
        arrays = {member: archive.read(member) for member in archive.namelist()}
    out = io.BytesIO()
    np.save(out, change(np.load(io.BytesIO(arrays[f"{name}.npy"]))), allow_pickle=True)
    arrays[f"{name}.npy"] = out.getvalue()
    with zipfile.ZipFile(path, "w") as archive:
        for member, data in arrays.items():
            archive.writestr(member, data)


def says(**values):
    def change(about):
        return np.frombuffer(json.dumps(json.loads(about.tobytes()) | values).encode(), np.uint8)

    return change


@pytest.mark.parametrize(
    ("name", "change"),
    [
        ("0.color", lambda array: np.array([{}], object)),
        ("0.color", lambda array: array.astype(np.float64)),
        ("0.color", lambda array: np.zeros((0, 0, 1 << 40), np.float32)),
        ("0.color", lambda array: array[:1]),
        ("0.keys", lambda array: array[::-1]),
        ("0.keys", lambda array: array + (np.uint64(1) << np.uint64(32))),
        ("0.shares", lambda array: array[:5]),
        ("about", says(place=[-4, 0, 4, 3])),
        ("about", says(place=[0, 0, 4, 30])),
        ("about", says(place=[0, 0, 4.0, 3])),
        ("about", says(size="88")),
        ("about", says(frames=[[1, 2]])),
        ("about", says(names=[{"a": 1 << 40}])),
        ("about", lambda about: np.frombuffer(b"[" * 100_000, np.uint8)),
    ],
)
def test_what_is_impossible_is_refused_with_the_name_of_the_file(name, change, parts):
    rewritten(parts[0], name, change)
    with pytest.raises(ValueError) as refused:
        joined_parts(parts, SIZE, 1)
    assert str(refused.value) == f"{parts[0]} is damaged or is not a part of a picture; draw it again."
