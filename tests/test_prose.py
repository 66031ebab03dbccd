# SPDX-License-Identifier: GPL-3.0-or-later
"""The words: spelt right, within their budget, in sentences that are understood at first reading."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
#: Words of prose in all of docs/: what tables, commands and pictures hold is not counted.
BUDGET = 8000
LONGEST_SENTENCE = 45
#: The README is one screen.
README_LINES = 90
#: GLSL's `inout`, a name, and a variable.
NO_MISSPELLINGS = "inout,shepperd,acn"
#: What sends a reader to look twice -> what says it.
RIDDLES = {
    r"\bof which\b.*\bthat of\b": "say which thing has what",
    r"\bas far as it\b": "say how far",
    r"\bone by one measured\b": "measured one by one",
    r"\bin order to\b": "to",
    r"\butili[sz]e": "use",
    r"\bdue to the fact that\b": "because",
    r"\bit (?:should|must) be noted\b": "leave it out",
    r"\bsimply\b|\bobviously\b|\bof course\b": "leave it out",
}


def prose(page: Path) -> str:
    """The running text of a page, without tables, code blocks, pictures and headings."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text, flags=re.DOTALL)
    return "\n".join(line for line in text.splitlines() if not line.startswith(("|", "#")))


def sentences(text: str) -> list[str]:
    """A list's points and paragraphs end sentences too."""
    blocks = re.split(r"\n\s*\n|\n\s*(?:[*-]|\d+\.) ", text)
    ends = re.compile(r"(?<=[.!?:;])[)*\"]*\s+(?=[A-Z*`(\[])")
    return [s for block in blocks for s in ends.split(" ".join(block.split())) if s]


def test_the_words_are_spelt_right():
    folders = ["README.md", "docs", "splat_addon", "shaders", "scripts", "tests"]
    found = subprocess.run(
        [
            sys.executable,
            "-m",
            "codespell_lib",
            f"--ignore-words-list={NO_MISSPELLINGS}",
            "--skip=*.png,*.npy,*/translations/german.py",
            *folders,
        ],
        cwd=ROOT,
        capture_output=True,
        text=True,
    )
    assert found.returncode == 0, found.stdout + found.stderr


def test_the_documentation_keeps_within_its_budget():
    assert sum(len(prose(page).split()) for page in PAGES[1:]) <= BUDGET
    assert len(PAGES[0].read_text(encoding="utf-8").splitlines()) <= README_LINES


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_sentences_are_short_and_no_riddles(page):
    text = prose(page)
    long = [s for s in sentences(text) if len(s.split()) > LONGEST_SENTENCE]
    assert not long
    said = {riddle: better for riddle, better in RIDDLES.items() if re.search(riddle, text)}
    assert not said


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_what_a_page_links_to_exists(page):
    links = re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    missing = [link for link in links if "://" not in link and not (page.parent / link).exists()]
    assert not missing


def test_the_glossary_has_at_most_thirty_terms():
    lines = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8").splitlines()
    assert len([line for line in lines if line.startswith("| ")]) - 1 <= 30
