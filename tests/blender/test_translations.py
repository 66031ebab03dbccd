# SPDX-License-Identifier: GPL-3.0-or-later
"""Every text of the interface is translated, no translation is left over, and numbers in texts stay the same."""

import re

import bpy
import pytest

from splat_addon.blender import commands, translations
from splat_addon.blender.spoken import said
from splat_addon.blender.translations.german import AREAS, GERMAN
from splat_addon.blender.translations.messages import DEFAULT, OPERATOR


def figures(text: str) -> list[str]:
    """The numbers in a text, without separators."""
    return sorted(re.sub("[.,]", "", number) for number in re.findall(r"\d(?:[\d.,]*\d)?", text))


def test_what_is_shown_is_found(interface_texts):
    assert {
        (OPERATOR, "Convert to Surfels"),
        (DEFAULT, "Surfels"),  # the sidebar's tab
        (DEFAULT, "Three even greys, as with Toon"),  # a label in a panel's source
        (DEFAULT, "Tint"),  # one of two
        (DEFAULT, "How a splat is drawn and filtered"),
        (DEFAULT, "Leave them out, since most are errors of the scanner"),  # of an operator's choice
        (OPERATOR, "Bake Materials"),  # a button
    } <= interface_texts


def test_every_text_is_there_in_german_and_no_other(interface_texts):
    texts = {text for _, text in interface_texts}
    assert {"missing": texts - set(GERMAN), "left over": set(GERMAN) - texts} == {"missing": set(), "left over": set()}
    assert all(said.strip() and not said.endswith(".") for said in GERMAN.values())


def test_each_text_is_in_one_area_in_alphabetical_order():
    assert sum(len(area.TEXTS) for area in AREAS) == len(GERMAN)
    assert all(list(area.TEXTS) == sorted(area.TEXTS, key=lambda text: (text.casefold(), text)) for area in AREAS)


def test_german_has_the_figures_of_the_english():
    assert {text: said for text, said in GERMAN.items() if figures(text) != figures(said)} == {}


def test_german_has_the_values_of_the_english():
    """In the same formats, so that nothing that is put together fails in another language."""
    values = {text: sorted(re.findall(r"{[^}]*}", text)) for text in GERMAN}
    assert {text: said for text, said in GERMAN.items() if sorted(re.findall(r"{[^}]*}", said)) != values[text]} == {}
    assert sum(map(bool, values.values())) > 10


def test_short_names_stay_short():
    """A translated label must fit in the panel where the English label fits."""
    long = {text: said for text, said in GERMAN.items() if len(text) <= 20 and len(said) > 32}
    assert not long


def test_blender_says_it_in_german():
    if "de_DE" not in bpy.app.translations.locales and "de" not in bpy.app.translations.locales:
        pytest.skip("this Blender was built without other languages, as its wheels are")
    view = bpy.context.preferences.view
    kept = view.language
    view.language = "de_DE" if "de_DE" in bpy.app.translations.locales else "de"
    try:
        assert bpy.app.translations.pgettext_iface("Convert to Surfels", OPERATOR) == "In Surfels umwandeln"
        assert said("No surfels of {name} yet", name="Suzanne") == "Noch keine Surfels von Suzanne"
        assert bpy.app.translations.pgettext_tip("The balance between speed and accuracy").startswith("Das V")
    finally:
        view.language = kept


def test_the_template_replaces_only_one_that_is_as_it_was_written(tmp_path, capsys):
    file = tmp_path / "texts.pot"
    assert commands.run(["template", str(file)]) == 0 == commands.run(["template", str(file)])
    written = file.read_bytes()
    for others in (
        b"",
        b"BLENDER",
        written.replace(b'msgstr ""', b'msgstr "Ansicht"'),
        written[:-1],
        b"\xff" + written,
    ):
        file.write_bytes(others)
        assert commands.run(["template", str(file)]) == 1 and file.read_bytes() == others
        assert "is no template as this command writes it; name another file" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["texts.pot"]


def test_the_template_follows_no_link(tmp_path, capsys):
    for target in (tmp_path / "scene.blend", tmp_path / "not there"):
        link = tmp_path / "texts.pot"
        try:
            link.symlink_to(target)
        except OSError:
            pytest.skip("Links need a right on Windows.")
        assert commands.run(["template", str(link)]) == 1
        assert "is a link, which is not followed" in capsys.readouterr().err and not target.exists()
        link.unlink()


def test_the_template_has_each_text_once(interface_texts, tmp_path):
    file = tmp_path / "surfels.pot"
    assert commands.run(["template", str(file)]) == 0
    entries = file.read_text(encoding="utf-8").split("\n\n")[1:]
    assert len(entries) == len(interface_texts)
    assert 'msgctxt "Operator"\nmsgid "Convert to Surfels"\nmsgstr ""' in [entry.strip() for entry in entries]


def test_blender_takes_the_catalogue():
    for texts in translations.catalogue().values():
        assert all(isinstance(key, tuple) and isinstance(said, str) for key, said in texts.items())
