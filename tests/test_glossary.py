# SPDX-License-Identifier: GPL-3.0-or-later
"""Each term of docs/glossary.md is used in the documentation and in the code, and no synonym takes its place."""

import re

import pytest

from .test_prose import PAGES, ROOT, SOURCES, comments, docstrings

GLOSSARY = ROOT / "docs" / "glossary.md"
#: Pattern of a synonym -> the term of the glossary to use instead.
SYNONYMS = {
    r"\bsurface elements?\b|\bpoint splats?\b": "surfel",
    r"\bsemi-?ax[ei]s\b|\bhalf ax[ei]s\b": "half-axis",
    r"\b(?:face|true|plane) normals?\b": "geometric normal",
    r"\b(?:shaded|lit) normals?\b": "shading normal",
    r"\b(?:sampling|grid) (?:steps?|distances?|intervals?|pitch)\b": "spacing (H)",
    r"\b(?:cut|cutting|cut-off|clipping) lines?\b": "clip line",
    r"\bblend(?:ing)? (?:distance|range)s?\b|\bblending depths?\b": "blend depth",
    r"\bpre-?filter(?:s|ed|ing)?\b": "low-pass",
    r"\b(?:z|depth)-?(?:pre)?-pass\b": "visibility pass",
    r"\b(?:splat|sum|G-buffer) pass(?:es)?\b": "attribute pass",
    r"\bshading pass(?:es)?\b": "lighting pass",
    r"\b(?:lighting|shader) models?\b": "shading model",
    r"\b(?:splatting|drawing) (?:technique|algorithm)s?\b": "method",
    r"\b(?:rendering|renderer|rasterization) errors?\b": "splatting error",
    r"\b(?:sampling|modelling|conversion) errors?\b": "representation error",
    r"\bnumpy (?:copy|version|port|mirror)\b": "twin",
}


def terms() -> dict[str, str]:
    """Term -> its meaning; a row may have several terms, and a symbol in parentheses."""
    rows = [line.strip("| \n").split(" | ") for line in GLOSSARY.read_text(encoding="utf-8").splitlines()]
    table = [row for row in rows if len(row) == 2 and row[0] != "term"]
    return {term: meaning for cell, meaning in table for term in re.sub(r" \(.*\)", "", cell).split(", ")}


def uses(term: str, text: str) -> bool:
    """Whether a text in small letters, without underscores, has the term."""
    return bool(re.search(rf"\b{term.lower().removesuffix('is')}(?:s|is|es)?\b", text))


@pytest.fixture(scope="module")
def documentation() -> str:
    pages = " ".join(" ".join(page.read_text(encoding="utf-8").split()) for page in PAGES if page != GLOSSARY)
    return pages.replace("_", " ").lower()


@pytest.fixture(scope="module")
def code(explanations) -> str:
    """All docstrings and comments, each on a line."""
    return "\n".join(text for texts in explanations.values() for text in texts).replace("_", " ").lower()


@pytest.fixture(scope="module")
def explanations() -> dict[str, list[str]]:
    """Source -> its docstrings and comments, without this file's own."""
    files = [file for file in SOURCES if file.name != "test_glossary.py"]
    return {
        file.relative_to(ROOT).as_posix(): [" ".join(text.split()) for text in (*docstrings(file), *comments(file))]
        for file in files
    }


def test_the_glossary_is_read():
    assert {"surfel", "spacing", "hook", "half-axis", "low-pass"} <= set(terms()) and "Spacing (H)" not in terms()


@pytest.mark.parametrize("term", terms())
def test_a_term_is_used_in_the_documentation_and_in_the_code(term, documentation, code):
    assert uses(term, documentation), "it is missing in the documentation"
    assert uses(term, code), "it is missing in the code"


@pytest.mark.parametrize("synonym", SYNONYMS)
def test_no_synonym_takes_the_place_of_a_term(synonym, explanations):
    """docs/papers.md and the glossary itself may quote the papers' other words."""
    assert SYNONYMS[synonym].split(" (")[0] in terms()
    pages = [page for page in PAGES if page.name not in ("papers.md", "glossary.md")]
    found = [page.name for page in pages if re.search(synonym, page.read_text(encoding="utf-8"), re.IGNORECASE)]
    found += [f"{file}: {text[:80]}" for file, texts in explanations.items() for text in texts
              if re.search(synonym, text, re.IGNORECASE)]  # fmt: skip
    assert found == []
