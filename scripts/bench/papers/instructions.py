# SPDX-License-Identifier: GPL-3.0-or-later
"""Instructions of the vertex and fragment shaders of a method's passes, as the papers' tables count them.

The shaders are compiled to SPIR-V by `glslangValidator` and optimised by `spirv-opt -O`; every instruction in a
function counts but labels, variables, and the names of what is read and written (OpAccessChain). A paper's instruction
handles four numbers, and so do most of these.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from splat_addon.rendering import Settings, plan
from splat_addon.rendering.device.standalone import _declared
from splat_addon.rendering.plan.programs import describe
from splat_addon.whole_files import write_whole

TOOLS = "glslangValidator", "spirv-opt", "spirv-dis"
#: pass -> its vertex shader, if not that of its host
VERTEX = {"visibility": "visibility.vert", "shading": "fullscreen.vert"}
_UNCOUNTED = "OpLabel", "OpVariable", "OpAccessChain", "OpFunction", "OpFunctionParameter", "OpFunctionEnd"


def missing_tools() -> list[str]:
    return [tool for tool in TOOLS if not shutil.which(tool)]


def instructions(scene, camera, settings: Settings) -> Iterator[str]:
    """Instructions of the vertex / fragment shaders of visibility, attribute and lighting pass; - without a pass."""
    planned = plan(scene, camera, settings)
    passes = {p.name: p for p in planned.passes}
    for name in ("visibility", "attributes", "shading"):
        if name not in passes:
            yield "-"
            continue
        vertex = VERTEX.get(name, passes[name].host.vertex)
        variants = ("splats",) if name == "visibility" else ()
        description = describe(planned, passes[name], vertex, *variants)
        texts = _declared(description, description.vertex, "out"), _declared(description, description.fragment, "in")
        yield " / ".join(str(_count(text, stage)) for text, stage in zip(texts, ("vert", "frag"), strict=True))


def _count(text: str, stage: str) -> int:
    with TemporaryDirectory() as folder:
        source, module = Path(folder) / f"shader.{stage}", Path(folder) / "shader.spv"
        write_whole(source, text.encode("utf-8"))
        _run("glslangValidator", "-G", "--aml", "--amb", source, "-o", module)
        _run("spirv-opt", "-O", module, "-o", module)
        return sum(_is_counted(line) for line in _body(_run("spirv-dis", "--no-color", module)))


def _body(text: str) -> list[str]:
    """The instructions of all functions."""
    return text[text.index(" OpFunction ") :].splitlines()


def _is_counted(line: str) -> bool:
    operation = line.partition(" = ")[2] or line
    return operation.split()[:1] != [] and operation.split()[0] not in _UNCOUNTED


def _run(tool: str, *arguments) -> str:
    done = subprocess.run([tool, *map(str, arguments)], capture_output=True, text=True, encoding="utf-8")
    if done.returncode:
        raise RuntimeError(f"{tool} failed: {done.stdout[-800:]}{done.stderr[-800:]}")
    return done.stdout
