# SPDX-License-Identifier: GPL-3.0-or-later
"""Turns the output of pip or the system's loader into one sentence that names the remedy.

Each table is a list of (pattern in the text, sentence); the first match is used.
"""

from __future__ import annotations

import re
from functools import partial

DEBIAN = (
    "libegl1 libgl1 libgl1-mesa-dri libvulkan1 libx11-6 libxrender1 libxfixes3 libxi6 libxkbcommon0 "
    "libsm6 libice6 libxxf86vm1"
)
FEDORA = (
    "mesa-libEGL mesa-libGL mesa-dri-drivers vulkan-loader libX11 libXrender libXfixes libXi libxkbcommon "
    "libSM libICE libXxf86vm"
)

IMPORT_PROBLEMS = (
    (
        r"(lib[\w.+-]+\.so[.\d]*): cannot open shared object file",
        "Blender needs the system library {0}, which is missing: install the set with "
        f"`sudo apt install {DEBIAN}` on Debian or `sudo dnf install {FEDORA}` on Fedora, "
        "and on Windows (WSL included) do that inside the Linux that runs this.",
    ),
    (
        r"(DLL load failed while importing \w+)",
        "Blender needs a system library that is missing ({0}): on Windows install the Microsoft Visual C++ "
        "Redistributable and the graphics card's driver (`winget install Microsoft.VCRedist.2015+.x64`).",
    ),
    (
        r"version `(GLIBC\w*_[\d.]+)' not found",
        "This Linux is too old for this Blender, which needs {0}: take Debian 12, Fedora 38 or a newer one.",
    ),
)

INSTALL_PROBLEMS = (
    (
        r"No space left on device|not enough space on the disk",
        "The disk is full, and the environment needs about 2 GB: free some space and run this again.",
    ),
    (
        r"Failed to establish a new connection|Temporary failure in name resolution|getaddrinfo failed|"
        r"Max retries exceeded|Read timed out|ConnectionError|ProxyError|SSLError|IncompleteRead|ConnectionResetError",
        "The packages could not be downloaded because the package index did not answer: check the network "
        "(and the proxy, if there is one) and run this again.",
    ),
    (
        r"THESE PACKAGES DO NOT MATCH THE HASHES",
        "A downloaded package was damaged: empty pip's cache with `python3 -m pip cache purge` and run this again.",
    ),
    (
        r"No matching distribution found for (\S+)",
        "The package index has no {0} for this system: the wheels of Blender are made for 64-bit Linux and Windows "
        "on Intel and macOS on Apple silicon.",
    ),
)


def _known_problem(table, text: str) -> str | None:
    """The sentence for the output of a failed process; None if no pattern matches."""
    for pattern, sentence in table:
        match = re.search(pattern, text)
        if match:
            return sentence.format(*match.groups())
    return None


#: Text -> sentence, for a failed `import bpy` and for a failed `pip install`.
import_problem, install_problem = (partial(_known_problem, table) for table in (IMPORT_PROBLEMS, INSTALL_PROBLEMS))


def last_line(text: str) -> str:
    """The last non-empty line, for errors that no table covers."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    return lines[-1].rstrip(".") if lines else "it printed nothing"
