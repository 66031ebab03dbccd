# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/papers.md is complete and correct.

Its files and tests exist, it lists everything in the papers, and it has a row for each section and equation that the
code cites.
"""

import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGE = ROOT / "docs" / "papers.md"
STATES = "**As printed**", "**Corrected**", "**Surpassed**", "**Otherwise**", "**Not here**"
#: What was measured: decibels, shares, or a range of times; and where its command is.
MEASURED = re.compile(r"\d dB|\d %|\d\.\d+ (?:to|and) \d|takes \d|\d times\b|[1-9] / \d")
SOURCE = re.compile(
    r"`python3 scripts/[^`]+`[^|]*?commit [0-9a-f]{7}|\]\(evidence/\w+\.md\)|[Cc]ommand is that of|the row of|"
    r"has the command|the last test"
)

#: paper -> (how code names it, its sections, and how many equations, figures and tables it has)
PAPERS = {
    "Botsch and Kobbelt 2003": (r"Botsch(?:,| and) Kobbelt", "1 2 3 3.1 3.2 3.3 3.4 4 5 6", 4, 9, 1),
    "Botsch et al. 2005": (r"Botsch(?: et al\.|, Hornung)", "1 2 3 4 4.1 5 6 7", 2, 5, 1),
    "Guennebaud et al. 2006": (r"Guennebaud", "1 2 3 3.1 3.2 4 4.1 4.2 5 5.1 5.2 6 7 8", 10, 6, 1),
    "View-independent object-space surface splatting": (
        r"[Vv]iew-independent (?:paper|object-space)", "1 2 3 4 4.1 4.2 4.3 4.4 4.5 5 6", 14, 10, 6,
    ),
}  # fmt: skip
KINDS = {"Section": 0, "Equation": 1, "Figure": 2, "Table": 3}

_NUMBERS = r"(\d+(?:\.\d+)?(?:(?:, | and | to )\d+(?:\.\d+)?)*)"
_CITED = re.compile(rf"\b(section|equation|figure|table)s? {_NUMBERS}", re.IGNORECASE)


def rows(paper: str) -> list[list[str]]:
    """The cells of each line of the page's table."""
    text = PAGE.read_text(encoding="utf-8").split(f"## {paper}\n")[1].split("\n## ")[0]
    lines = [line for line in text.splitlines() if line.startswith("| ")]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines[1:]]


def numbers(text: str) -> list[str]:
    return re.findall(r"\d+(?:\.\d+)?", text)


def told(paper: str, kind: str) -> set[str]:
    """The numbers that the rows of one kind cover."""
    items = [item.split(",")[0] if item.startswith("Section ") else item for item, *_ in rows(paper)]
    return {number for item in items if item.startswith(kind) for number in numbers(item)}


def parts(paper: str, kind: str) -> set[str]:
    """The numbers of all of a paper's sections, equations or figures."""
    _, sections, *counts = PAPERS[paper]
    if kind == "Section":
        return set(sections.split())
    return {str(number + 1) for number in range(counts[KINDS[kind] - 1])}


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("paper", PAPERS)
def test_nothing_of_a_paper_is_left_out(paper, kind):
    assert told(paper, kind) == parts(paper, kind)


@pytest.mark.parametrize("paper", PAPERS)
def test_every_row_says_how_it_is_and_every_equation_names_its_test(paper):
    for item, what, _, how, test in rows(paper):
        assert what and how.startswith(STATES), item
        assert not item.startswith("Equation") or "::" in test, item


@pytest.mark.parametrize("paper", PAPERS)
def test_every_figure_has_its_command_and_commit(paper):
    """They are in the row, on the page of evidence that it links, or in the row that it refers to."""
    assert [item for item, _, _, how, _ in rows(paper) if MEASURED.search(how) and not SOURCE.search(how)] == []


def test_files_and_tests_that_are_named_exist():
    for name in re.findall(r"`([\w./-]+/[\w./:-]+)`|\]\(([\w./-]+\.md)\)", PAGE.read_text(encoding="utf-8")):
        path, _, test = (name[0] or f"docs/{name[1]}").partition("::")
        assert (ROOT / path).exists(), path
        assert not test or f"def {test}(" in (ROOT / path).read_text(encoding="utf-8"), test


def citations():
    """(file, paper, kind, number) for each citation of the papers in the code."""
    names = re.compile("|".join(f"(?P<p{number}>{paper[0]})" for number, paper in enumerate(PAPERS.values())))
    files = [p for folder in ("splat_addon", "shaders", "scripts", "tests") for p in (ROOT / folder).rglob("*")]
    for path in (p for p in files if p.suffix in (".py", ".glsl") and p != Path(__file__).resolve()):
        text = re.sub(r"\n(?://|#:?|\s)*", " ", path.read_text(encoding="utf-8"))
        for found in names.finditer(text):
            paper = list(PAPERS)[int(found.lastgroup[1:])]
            cited = re.split(r"[;)]|\.\s(?!\d)|\"\"\"|Zwicker|Ren et al", text[found.end() : found.end() + 260])[0]
            if paper.startswith("Botsch") and paper[-4:] not in text[found.start() : found.end() + 120]:
                continue
            for kind, listed in _CITED.findall(cited):
                for number in numbers(listed):
                    yield path.relative_to(ROOT).as_posix(), paper, kind.capitalize(), number


def test_the_code_cites_what_the_papers_have():
    found = list(citations())
    assert len(found) > 60
    assert [c for c in found if c[3] not in parts(c[1], c[2])] == []
