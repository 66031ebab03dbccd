# SPDX-License-Identifier: GPL-3.0-or-later
"""Composes shaders from hosts and features, without conditionals: features that a pass does not use add no line to it.

A *host* is a shader, or a function of several, with lines `#hook name(arguments)`, where features may act, and
`#parts`, where their functions are inserted. A *feature* has one file, shaders/features/<name>.glsl, of sections:

    #part HOST, WORD ...

A section is used if all its words apply: the host's file name, the stage (vertex, fragment), features that are present,
and further words of the pass (layer, opaque ...). At a hook, every function in these sections is called whose name
starts with the feature's name or one of the section's words and ends with the hook's name, in the order of the
features. Other functions are helpers. Any file may have such sections. `#include "path"` includes a file once per text;
{names} in a path are substituted.

`python3 -m splat_addon.rendering.plan.compose --help` tells how to print the text of a pass, with the origin of parts.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache
from pathlib import Path
from typing import NamedTuple

FOLDER = Path(__file__).resolve().parents[3] / "shaders"

_PART = re.compile(r"^#part (.+)\n", re.MULTILINE)
_HOOK = re.compile(r"^( *)#hook (\w+)\((.*)\)\n", re.MULTILINE)
_INCLUDE = re.compile(r'^#include "([^"]+)"\n', re.MULTILINE)
_PARTS = "#parts\n"
_STAGES = {"vert": "vertex", "frag": "fragment"}
_FUNCTION = re.compile(r"^\w+ (\w+)\(", re.MULTILINE)


#: Defaults for names in paths, if a frame does not choose.
DEFAULTS = {
    "method": "mip",
    "storage": "float32",
    "shading": "principled",
    "depth_format": "hardware",
    "sum_format": "float32",
    "samples": "each",
    "background": "even",
    "world_light": "even",
    "lighting_picture": "whole",
    "shadow_taps": "even",
    "polygon_share": "compared",
    "polygon_blend": "attributes",
    "polygon_light": "once",
    "sides": "told_apart",
    "rest_opacity": "surfaces",
    "faces": "one",
    "instances": "uniform",
}


class _Section(NamedTuple):
    words: tuple[str, ...]
    text: str


class _File(NamedTuple):
    """head: the text outside of sections."""

    head: str
    sections: tuple[_Section, ...]


@cache
def compose(root: str, words: tuple[str, ...] = (), names: tuple[tuple[str, str], ...] = (), origins=False) -> str:
    """The text of shaders/hosts/`root`.glsl. words: the features that are present, in their order, and further words of
    the pass. names: substitutions for {names} in paths. origins: add a comment at the beginning and end of each file.

    Raises FileNotFoundError for a missing file and ValueError for a feature's function without a hook.
    """
    return _Text(words, _STAGES[root.rpartition(".")[2]], dict(names), origins).included(f"hosts/{root}.glsl")


class _Text:
    """One text during composition; every file is included once."""

    def __init__(self, words: tuple[str, ...], stage: str, names: dict[str, str], origins: bool):
        self._words, self._stage, self._names, self._origins = words, stage, names, origins
        self._holds = {*words, stage}
        self._seen: set[str] = set()

    def included(self, path: str) -> str:
        path = path.format(**self._names)
        if path in self._seen:
            return ""
        self._seen.add(path)
        head, sections = _read(path)
        own = [section for section in sections if self._holds.issuperset(section.words)]
        if _PARTS not in head:
            return self._marked(path, self._expanded(head + "".join(section.text for section in own)))
        return self._marked(path, self._hosted(Path(path).stem, head, own))

    def _hosted(self, host: str, head: str, own: list[_Section]) -> str:
        """A host with its own sections and those of the features, and with calls of their functions at its hooks."""
        before, after = head.split(_PARTS)
        features = {word: self._sections_at(host, word) for word in self._words}
        hooks = _HOOK.findall(head + "".join(s.text for part in (own, *features.values()) for s in part))
        names = sorted({name for _, name, _ in hooks}, key=len, reverse=True)
        acting = [call for section in own for call in _calls(section, section.words, names)]
        parts = ["".join(section.text for section in own)]
        for feature, sections in features.items():
            for section in sections:
                acting += _calls(section, (feature, *section.words), names)
                if section.words[0] == host:
                    _check(section, feature, host, names)
            path = f"features/{feature}.glsl"
            parts.append(self._marked(path, "".join(section.text for section in sections)))
        text = _HOOK.sub(lambda match: _called(match, acting), before + "".join(parts) + after)
        return self._expanded(text)

    def _sections_at(self, host: str, feature: str) -> list[_Section]:
        """A feature's section for a host; what all its sections in the stage share precedes it, once per text."""
        path = f"features/{feature}.glsl"
        if not _exists(path):
            return []
        head, sections = _read(path)
        taken = [s for s in sections if s.words[0] == host and self._holds.issuperset(s.words[1:])]
        if taken and path not in self._seen:
            self._seen.add(path)
            shared = [s for s in sections if s.words == (self._stage,)]
            taken = [_Section((self._stage,), head), *shared, *taken]
        return taken

    def _expanded(self, text: str) -> str:
        return _INCLUDE.sub(lambda match: self.included(match[1]), text)

    def _marked(self, path: str, text: str) -> str:
        return f"// >>> {path}\n{text.strip()}\n// <<< {path}\n" if self._origins and text else text


def _calls(section: _Section, words: Iterable[str], hooks: list[str]) -> Iterable[tuple[str, str]]:
    """(hook, function) for each function of a section that hooks call; the longest matching hook name counts."""
    for function in _FUNCTION.findall(section.text):
        if function.startswith(tuple(f"{word}_" for word in words)):
            if hook := next((hook for hook in hooks if function.endswith(f"_{hook}")), ""):
                yield hook, function


def _check(section: _Section, feature: str, host: str, hooks: list[str]) -> None:
    for function in _FUNCTION.findall(section.text):
        if function.startswith(f"{feature}_") and not function.endswith(tuple(f"_{hook}" for hook in hooks)):
            raise ValueError(
                f"features/{feature}.glsl has a function {function} for the host {host}, whose hooks are "
                f"{', '.join(hooks)}; call it by one of them, or begin a helper's name otherwise."
            )


def _called(match: re.Match, acting: list[tuple[str, str]]) -> str:
    indent, hook, arguments = match.groups()
    return "".join(f"{indent}{function}({arguments});\n" for at, function in acting if at == hook)


@cache
def _read(path: str) -> _File:
    head, *rest = _PART.split((FOLDER / path).read_text(encoding="utf-8"))
    sections = zip(rest[::2], rest[1::2], strict=True)
    return _File(head, tuple(_Section(tuple(re.split(r"[ ,]+", words)), text) for words, text in sections))


@cache
def _exists(path: str) -> bool:
    return (FOLDER / path).exists()
