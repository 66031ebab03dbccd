# SPDX-License-Identifier: GPL-3.0-or-later
"""Online Manual leads from every setting and every operator to a heading of a page in docs/."""

import re
from pathlib import Path
from urllib.parse import unquote, urlsplit

import bpy
import pytest

from splat_addon.blender import manual

ROOT = Path(manual.__file__).resolve().parents[2]
GROUPS = (bpy.types.PropertyGroup, bpy.types.AddonPreferences)


def ours(base) -> list[type]:
    every = [made for made in subclasses(base) if made.__module__.startswith("splat_addon")]
    return [made for made in every if getattr(made, "is_registered", False)]


def subclasses(base):
    for each in base.__subclasses__():
        yield each
        yield from subclasses(each)


def names() -> list[str]:
    """Blender's names of everything whose context menu has the entry Online Manual."""
    groups = [made for base in GROUPS for made in ours(base)]
    assert len(groups) >= 7
    settings = [f"{made.__name__}.{p.identifier}" for made in groups for p in made.bl_rna.properties]
    operators = [made.bl_idname for made in ours(bpy.types.Operator)]
    assert len(operators) >= 9
    return [*(f"bpy.types.{name}" for name in settings), *(f"bpy.ops.{name}" for name in operators)]


def address(name: str) -> str | None:
    """The address that Blender itself opens."""
    return bpy.types.WM_OT_doc_view_manual._lookup_rna_url(name, verbose=False)


def headings(page: Path) -> set[str]:
    """The anchors that renderers of Markdown make from the page's headings."""
    lines = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", line.lower()).replace(" ", "-") for line in lines}


def test_everything_has_a_page_and_a_heading_that_are_there():
    for name in names():
        found = address(name)
        assert found, name
        parts = urlsplit(found)
        page = Path(unquote(parts.path))
        assert page.parent == ROOT / "docs" and page.is_file(), (name, found)
        assert parts.fragment in headings(page), (name, found)


def test_each_line_of_the_table_is_used():
    """Blender uses the first line that fits, so a line that is never reached is an error."""
    used = {manual_line(name) for name in names()}
    assert used == {pattern for pattern, _ in manual.PAGES}


def manual_line(name: str) -> str:
    find = bpy.types.WM_OT_doc_view_manual._find_reference
    return next(pattern for pattern, page in manual.PAGES if find(name, [(pattern, page)], verbose=False))


def test_a_website_of_the_manifest_has_the_pages(monkeypatch, tmp_path):
    (tmp_path / "blender_manifest.toml").write_text('website = "https://splats.invalid/project/"\n')
    monkeypatch.setattr(manual, "_ROOT", tmp_path)
    assert address("bpy.ops.object.surfels_from_mesh") == (
        "https://splats.invalid/project/docs/guide.md#convert-a-mesh"
    )


@pytest.mark.parametrize("name", ["bpy.types.Object.location", "bpy.ops.object.shade_smooth"])
def test_blender_s_own_keep_their_manual(name):
    assert "docs/guide" not in (address(name) or "") and "docs/choose" not in (address(name) or "")
