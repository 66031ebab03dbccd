# SPDX-License-Identifier: GPL-3.0-or-later
"""Values kept between processes are found again only for equal arguments, and are discarded when their sources
change.
"""

from pathlib import Path

import numpy as np
import pytest

from splat_addon.reference import kept
from splat_addon.reference.extremes import discs
from splat_addon.rendering import Scene

#: A truth that depends on a description of the scene, and that on a sibling and a table; and what no truth depends on.
PRODUCT = {
    "reference/truth.py": "from ..rendering.scene import Scene",
    "rendering/scene/__init__.py": "from .scene import Scene",
    "rendering/scene/scene.py": "def f():\n    from ...surfels import Surfels",
    "rendering/scene/table.npy": "1",
    "surfels.py": "1",
    "rendering/__init__.py": "from . import renderer",
    "rendering/renderer.py": "from .scene import Scene",
}


@pytest.fixture
def counted():
    """A kept function that counts how often it runs."""
    runs = []

    def doubled(values, add=0):
        runs.append(add)
        return 2 * values + add

    return kept.remembered(doubled), runs


@pytest.fixture(autouse=True)
def elsewhere(tmp_path, monkeypatch):
    """A small product, stored in a separate folder."""
    monkeypatch.setattr(kept, "ROOT", tmp_path)
    for name, text in PRODUCT.items():
        file = tmp_path / "splat_addon" / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    as_a_new_process()
    yield tmp_path
    as_a_new_process()


def as_a_new_process():
    kept.folder.cache_clear()
    kept.dependencies.cache_clear()


def test_equal_arguments_are_found_again_and_others_are_not(counted):
    doubled, runs = counted
    for values in (np.arange(3), np.arange(3), np.arange(3) + 1):
        np.testing.assert_array_equal(doubled(values), 2 * values)
    assert len(runs) == 2
    doubled(np.arange(3), add=1)
    assert len(runs) == 3


@pytest.mark.parametrize("changed", PRODUCT)
def test_a_change_of_what_a_truth_depends_on_forgets_it(changed, counted, elsewhere):
    doubled, runs = counted
    doubled(np.arange(3))
    with (elsewhere / "splat_addon" / changed).open("a") as file:
        file.write("\n# changed")
    as_a_new_process()
    doubled(np.arange(3))
    assert len(runs) == (1 if changed in ("rendering/__init__.py", "rendering/renderer.py") else 2)


def test_truths_depend_on_the_scene_and_on_no_pass(monkeypatch):
    monkeypatch.setattr(kept, "ROOT", Path(kept.__file__).parents[2])
    found = kept.dependencies()
    assert {"splat_addon/surfels/surfels.py", "splat_addon/rendering/shading_models/brdf_table.npy"} <= set(found)
    rooms = "rendering/plan/", "rendering/features/", "rendering/renderer.py", "blender/"
    assert not [file for file in found if file.startswith(tuple(f"splat_addon/{room}" for room in rooms))]


def test_a_few_older_folders_stay(elsewhere):
    for number in range(kept.KEPT + 3):
        (elsewhere / "splat_addon" / "surfels.py").write_text(str(number))
        as_a_new_process()
        newest = kept.folder("few", "splat_addon/*.py")
    assert newest.is_dir() and len(list(newest.parent.iterdir())) == kept.KEPT


def test_what_is_written_is_whole_and_leaves_nothing_beside(elsewhere):
    for contents in (b"long contents", b"short"):
        kept.write(elsewhere / "file", contents)
        assert (elsewhere / "file").read_bytes() == contents
    assert [path.name for path in elsewhere.iterdir() if path.is_file()] == ["file"]


def test_what_was_computed_from_a_scene_does_not_make_it_another():
    """A scene remembers functions that it was asked with, which cannot be stored."""
    one, other, different = (Scene((discs((0, 0, z), (0.1, 0, 0), (0, 0.1, 0)),)) for z in (-2, -2, -3))
    assert one.table.of_kinds(lambda placed: placed.is_textured).tolist() == [False]
    assert kept.contents(one) == kept.contents(other) != kept.contents(different)
