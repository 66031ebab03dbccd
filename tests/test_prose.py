# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts are spelt correctly, keep within their budget, and consist of sentences understood at first reading."""

import ast
import io
import re
import subprocess
import sys
import tokenize
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
#: Words of prose in all of docs/, without tables, commands and pictures.
BUDGET = 8000
LONGEST_SENTENCE = 45
#: The README is one screen.
README_LINES = 90
#: GLSL's `inout`, a name, a variable, and a command.
NO_MISSPELLINGS = "inout,shepperd,acn,lod"
#: Pattern of a phrase that has to be read twice -> what to write instead.
RIDDLES = {
    r"\bof which\b.*\bthat of\b": "say which thing has what",
    r"\bas far as it\b": "say how far",
    r"\bone by one measured\b": "measured one by one",
    r"\bin order to\b": "to",
    r"\butili[sz]e": "use",
    r"\bdue to the fact that\b": "because",
    r"\bit (?:should|must) be noted\b": "leave it out",
    r"\bsimply\b|\bobviously\b|\bof course\b": "leave it out",
    r"\bthat which\b|\bthose which\b": "name the thing",
    r"\bof so many\b": "of this number of",
    r"\btells? of\b": "describes, reports",
    r"\bin vain\b": "without effect",
    r"\banew\b": "again",
    r"\bas ever\b": "as usual",
    r"\bask(?:ed)? for by\b|\bis asked of\b": "say who needs what",
    r"(?:^|[.;:] )Who\b": "say who does what",
    r"\b(?:have|has) not (?:its|the|a|it|them)\b": "lack, do not have",
}
#: Further patterns for code: fragments whose subject a reader has to guess.
FRAGMENTS = {
    r"^(?:Of|By|Whose|Nor)\b(?!.*, )": "name the thing first",
    r"^As [^,]*$": "say what is so",
    r"^(?:\.\.\.|Not where\b)": "write a sentence",
    r"^(?:That|Those) (?:of|in|which)\b": "name it",
    r"\blet(?:s|ting)? go of\b": "free",
}
#: A test's docstring says what holds, so each of its sentences has one of these verbs. Add the verb that yours has.
VERBS = re.compile(
    r"\b(?:is|are|was|were|has|have|had|does|do|did|can|could|may|might|must|will|would|shall|should|cannot"
    r"|(?:accept|add|become|begin|belong|change|check|coincide|come|compare|compute|consist|contain|contribute|convert"
    r"|cover|cross|cut|decide|depend|differ|distinguish|draw|enclose|end|equal|exist|face|fall|fill|get|give|go|grow|happen|hold"
    r"|interpolate|join|keep|know|lack|lean|leave|lie|list|look|make|mark|match|meet|miss|move|name|need|pass|point|print|project"
    r"|promise|prove|put|reach|read|refuse|remain|return|run|see|set|show|stand|start|stay|stick|store|take|tell|turn|use"
    r"|vary|widen|wrap|write)(?:s|es)?|falls|goes|shadows|varies)\b"
)
#: The first sentence of a docstring says what the thing is for.
LONGEST_SUMMARY = 50
SOURCES = sorted(
    file
    for folder in ("splat_addon", "shaders", "scripts", "tests")
    for file in (ROOT / folder).rglob("*")
    if file.suffix in (".py", ".glsl") and "translations" not in file.parts
)


def prose(page: Path) -> str:
    """The running text of a page, without tables, code blocks, pictures, headings and what a bench writes."""
    text = re.sub(r"```.*?```|<!-- measured: .*?<!-- end -->", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    text = re.sub(r"!\[[^\]]*\]\([^)]*\)", "", text, flags=re.DOTALL)
    return "\n".join(line for line in text.splitlines() if not line.startswith(("|", "#")))


def sentences(text: str) -> list[str]:
    """The sentences of a text; points of a list and paragraphs end sentences too."""
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
            "--skip=*.png,*.npy,*/translations/german/*",
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


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_commands_and_files_that_a_page_names_exist(page):
    text = page.read_text(encoding="utf-8")
    names = [f"scripts/*/{name}*" for name in re.findall(r"scripts/bench\.py ([a-z]+)", text)]
    names += re.findall(r"python3 ([a-z]\w*/[\w./]+\.py)", text)
    names += re.findall(r"`((?:tests|splat_addon|shaders|scripts|docs)/[\w./*-]+)", text)
    assert [name for name in names if not any(ROOT.glob(name))] == []


def test_the_glossary_has_at_most_thirty_terms():
    lines = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8").splitlines()
    assert len([line for line in lines if line.startswith("| ")]) - 1 <= 30


@cache
def nodes(file: Path) -> list[ast.AST]:
    """All nodes of a Python file's syntax tree, the module first."""
    return list(ast.walk(ast.parse(file.read_text(encoding="utf-8"))))


@cache
def docstrings(file: Path) -> list[str]:
    documented = (ast.Module, ast.ClassDef, ast.FunctionDef)
    of_code = nodes(file) if file.suffix == ".py" else ()
    return [doc for node in of_code if isinstance(node, documented) and (doc := ast.get_docstring(node))]


@cache
def comments(file: Path) -> list[str]:
    """The comments of a file; consecutive lines are one comment."""
    text = file.read_text(encoding="utf-8")
    if file.suffix == ".py":
        tokens = tokenize.generate_tokens(io.StringIO(text).readline)
        lines = {t.start[0]: t.string.lstrip("#: ") for t in tokens if t.type == tokenize.COMMENT}
    else:
        lines = {i: line.split("//", 1)[1].strip() for i, line in enumerate(text.splitlines()) if "//" in line}
    whole: dict[int, str] = {}
    for number, line in lines.items():
        whole[number] = f"{whole.pop(number - 1)} {line}" if number - 1 in whole else line
    return list(whole.values())


def test_code_is_explained_without_riddles():
    said = [
        f"{file.relative_to(ROOT)}: {text[:80]!r}: {better}"
        for file in SOURCES
        for text in (*docstrings(file), *comments(file))
        for riddle, better in (RIDDLES | FRAGMENTS).items()
        if re.search(riddle, text)
    ]
    assert said == []


def is_sentence(text: str) -> bool:
    """Whether a text has a verb, or only explains a parameter, or gives a measurement."""
    return bool(VERBS.search(text) or re.match(r"[a-z_]+(?:, [a-z_]+)*: |Measured\b", text))


def test_what_a_test_holds_is_said_in_sentences():
    fragments = [
        f"{file.relative_to(ROOT)}: {node.name}: {sentence!r}"
        for file in sorted((ROOT / "tests").rglob("test_*.py"))
        for node in nodes(file)
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
        for sentence in sentences(ast.get_docstring(node) or "")
        if not is_sentence(sentence)
    ]
    assert fragments == []


@pytest.mark.parametrize("text", ["Of edges 2, active and selected.", "By the commands' own parser.", "As Blender's."])
def test_a_fragment_is_found(text):
    assert not is_sentence(text) or any(re.search(fragment, text) for fragment in FRAGMENTS)


def test_docstrings_begin_with_a_short_sentence_and_end_one():
    bad = []
    for file in SOURCES:
        is_operator = "_OT_" in file.read_text(encoding="utf-8")
        for text in docstrings(file):
            first = re.split(r"(?<=[.:;])\s", " ".join(text.split("\n\n")[0].split()))[0]
            ends = text.rstrip()[-1] in ".:`)|\"'" or is_operator or text.rstrip().count("\n")
            if len(first.split()) > LONGEST_SUMMARY or not ends:
                bad.append(f"{file.relative_to(ROOT)}: {text[:80]!r}")
    assert bad == []
