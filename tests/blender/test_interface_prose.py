# SPDX-License-Identifier: GPL-3.0-or-later
"""The words of the interface: tooltips are short sentences without measured figures, and labels fit the sidebar."""

import re

import bpy
import pytest

from splat_addon.blender.translations.messages import spoken
from tests.test_glossary import SYNONYMS
from tests.test_prose import RIDDLES

LONGEST_LABEL = 34
LONGEST_TOOLTIP_SENTENCE = 30
#: Measured figures go stale; docs/evidence has them with their commands.
MEASURED = re.compile(
    r"\d\s*(?:%|dB|ms|s\b|seconds?|bytes?|[kMG]i?B|megabytes)|\d(?:\.\d+)? times\b|FLIP|microsecond", re.I
)


@pytest.fixture(scope="module")
def tooltips(interface_texts) -> list[str]:
    """The texts of more than five words, which explain something."""
    return sorted({text for _, text in interface_texts if len(text.split()) > 5} - spoken())


@pytest.fixture(scope="module")
def labels(interface_texts) -> list[str]:
    return sorted({text for _, text in interface_texts if len(text.split()) <= 5} - spoken())


def test_sentences_that_are_put_together_are_short_and_no_riddles():
    """Reports and messages end without a full stop, as Blender's own, and may begin with a value."""
    texts = spoken()
    assert len(texts) > 25
    for text in texts:
        assert re.match(r"[A-Z{≈]", text) and not text.endswith("."), text
        assert len(text.split()) <= LONGEST_TOOLTIP_SENTENCE and not MEASURED.search(text), text
        assert not [riddle for riddle in RIDDLES if re.search(riddle, text)], text


def test_tooltips_are_no_riddles(tooltips):
    assert [(text, riddle) for text in tooltips for riddle in RIDDLES if re.search(riddle, text)] == []


def test_the_interface_uses_the_terms_of_the_glossary(interface_texts):
    texts = {text for _, text in interface_texts}
    assert [(text, word) for text in texts for word in SYNONYMS if re.search(word, text, re.IGNORECASE)] == []


def test_tooltips_have_no_measured_figures(tooltips):
    assert [text for text in tooltips if MEASURED.search(text)] == []


def test_a_measured_figure_is_found():
    for text in ("in 1.3 times the time", "within 1 %", "adds 35 s", "40 to 47 dB", "takes 8 to 12 bytes a surfel"):
        assert MEASURED.search(text), text


def test_tooltips_begin_with_a_capital_and_end_without_a_full_stop(tooltips):
    """Blender's own tooltips have the same form; Blender adds the full stop."""
    assert [text for text in tooltips if text.endswith(".") or not re.match(r"[A-Z0-9]", text)] == []


def test_sentences_of_tooltips_are_short(tooltips):
    sentences = [s for text in tooltips for s in re.split(r"(?<=[.:;])\s+|\s\(", text)]
    assert [s for s in sentences if len(s.split()) > LONGEST_TOOLTIP_SENTENCE] == []


def test_labels_fit_the_sidebar(labels):
    assert [text for text in labels if len(text) > LONGEST_LABEL] == []


def test_every_setting_has_a_tooltip():
    groups = (bpy.types.Scene, bpy.types.Object, bpy.types.ViewLayer)
    silent = []
    for owner in groups:
        for prop in owner.bl_rna.properties:
            if prop.identifier.startswith("surfel") and prop.type == "POINTER":
                silent += [
                    f"{prop.identifier}.{p.identifier}"
                    for p in prop.fixed_type.properties
                    if p.identifier not in ("rna_type", "name") and p.is_runtime and not p.is_hidden
                    and p.type not in ("POINTER", "COLLECTION") and not p.description
                ]  # fmt: skip
    assert silent == []
