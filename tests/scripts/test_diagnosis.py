# SPDX-License-Identifier: GPL-3.0-or-later
"""Output of the system's loader and of pip becomes one sentence with the remedy."""

import pytest

from environment.diagnosis import import_problem, install_problem, last_line

MISSING = "ImportError: libXi.so.6: cannot open shared object file: No such file or directory"


@pytest.mark.parametrize("part", ["libXi.so.6", "apt install", "libxi6", "dnf install", "libXi ", "Windows"])
def test_a_missing_library_is_named_with_its_remedy(part):
    assert part in import_problem(f"Traceback (most recent call last):\n  File x\n{MISSING}\n")


@pytest.mark.parametrize("name", ["libEGL.so.1", "libGL.so.1", "libxkbcommon.so.0", "libstdc++.so.6"])
def test_every_library_is_recognised(name):
    assert name in import_problem(f"OSError: {name}: cannot open shared object file: No such file or directory")


def test_a_missing_windows_library_names_the_runtime():
    text = "ImportError: DLL load failed while importing bpy: The specified module could not be found."
    assert "Visual C++" in import_problem(text)


def test_an_unknown_import_error_is_left_to_its_own_words():
    assert import_problem("ImportError: something new") is None


@pytest.mark.parametrize(
    ("text", "part"),
    [
        ("WARNING: Retrying ... Failed to establish a new connection: [Errno 101]", "network"),
        ("Temporary failure in name resolution", "network"),
        ("ERROR: No matching distribution found for bpy==5.2.3", "no bpy==5.2.3 for this system"),
        ("ERROR: Could not install: [Errno 28] No space left on device", "disk is full"),
        ("ERROR: THESE PACKAGES DO NOT MATCH THE HASHES FROM THE REQUIREMENTS FILE", "cache"),
    ],
)
def test_a_failed_download_is_explained(text, part):
    assert part in install_problem(text)


def test_a_dead_network_is_not_taken_for_a_missing_package():
    text = "Failed to establish a new connection\nERROR: No matching distribution found for bpy==5.2.3"
    assert "network" in install_problem(text)


@pytest.mark.parametrize("text", [MISSING, "DLL load failed while importing bpy", "version `GLIBC_2.38' not found"])
def test_an_explanation_is_one_line_and_one_sentence(text):
    sentence = import_problem(text)
    assert "\n" not in sentence and sentence.endswith(".") and ". " not in sentence


def test_the_last_words_of_an_output_are_found():
    assert last_line("first\n\n  last.  \n\n") == "last"
