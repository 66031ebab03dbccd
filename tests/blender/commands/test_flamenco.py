# SPDX-License-Identifier: GPL-3.0-or-later
"""Flamenco's job types compile, and the tasks that they make are command lines that the extension understands.

Flamenco itself is not run here. An engine for JavaScript runs the job types; COMPILER gives them what Flamenco's
manager gives a script (`author`, `path`, `print`, `frameChunker`), written from its documentation (Usage: Job Types,
Commands).
"""

import argparse
import json
from pathlib import Path

import pytest

quickjs = pytest.importorskip("quickjs")

SCRIPTS = Path(__file__).resolve().parents[3] / "farm" / "flamenco"

#: Goja, Flamenco's engine, runs scripts in strict mode; this refuses what it would refuse.
COMPILER = """
"use strict";
function only(object, names, what) {
  for (const name of Object.keys(object)) { if (!names.includes(name)) throw what + " has no " + name; }
}
const author = Object.freeze({
  Task(name, type) {
    if (!name.trim() || !type.trim()) throw "name and type are required";
    const task = { name: name, type: type, commands: [], dependencies: [] };
    task.addCommand = (command) => { task.commands.push(command); };
    task.addDependency = (other) => { task.dependencies.push(other.name); };
    return task;
  },
  Command(name, parameters) {
    if (name !== "blender-render") throw "no command " + name;
    only(parameters, ["exe", "exeArgs", "argsBefore", "blendfile", "args"], name);
    for (const list of [parameters.argsBefore, parameters.args]) {
      if (!Array.isArray(list) || !list.every((each) => typeof each === "string")) throw "lists hold strings";
    }
    return { name: name, parameters: parameters };
  },
});
function print() {}
function frameChunker(range, size) {
  if (size < 1) throw "invalid chunk size";
  const frames = [];
  for (const part of range.split(",")) {
    const ends = part.split("-").map(Number);
    for (let frame = ends[0]; frame <= ends[ends.length - 1]; frame++) frames.push(frame);
  }
  const chunks = [];
  for (let i = 0; i < frames.length; i += size) chunks.push(frames.slice(i, i + size).join(","));
  return chunks;
}
function compiled(settings) {
  const job = { settings: settings, tasks: [], addTask(task) { this.tasks.push(task); } };
  compileJob(job);
  return JSON.stringify(job.tasks);
}
"""

FRAMES = {"chunk_size": 4, "tile_columns": 1, "tile_rows": 1, "blendfile": "/a.blend", "output_pattern": "/out/f_####"}
SETTING = {
    "key", "type", "subtype", "choices", "propargs", "description", "default", "eval", "evalInfo", "visible",
    "required", "editable",
}  # fmt: skip


def load(name: str) -> "quickjs.Context":
    context = quickjs.Context()
    context.eval(f"{COMPILER}\n{(SCRIPTS / f'{name}.js').read_text()}")
    return context


def compiled(name: str, **settings) -> list[dict]:
    return json.loads(load(name).eval(f"compiled({json.dumps(settings)})"))


def lines(tasks: list[dict]) -> list[str]:
    return [" ".join(task["commands"][0]["parameters"]["args"]) for task in tasks]


def test_frames_go_in_chunks_and_are_checked():
    tasks = compiled("surfel_frames", frames="1-6,20", **FRAMES)
    assert lines(tasks) == [
        "--command surfels render --frames 1,2,3,4 --out /out/f_####",
        "--command surfels render --frames 5,6,20 --out /out/f_####",
        "--command surfels merge --frames 1-6,20 --out /out/f_####",
    ]
    assert tasks[2]["dependencies"] == ["render-1,2,3,4", "render-5,6,20"]
    assert {task["type"] for task in tasks} == {"blender"}
    assert tasks[0]["commands"][0]["parameters"]["blendfile"] == "/a.blend"


def test_tiles_are_merged_frame_by_frame():
    tasks = compiled("surfel_frames", frames="7-8", **{**FRAMES, "tile_columns": 3, "tile_rows": 2})
    said = lines(tasks)
    assert len(said) == 2 * (6 + 1) + 1
    assert "--command surfels render --frames 8 --tiles 3x2 --tile 3,1 --out /out/f_####" in said
    merge = next(task for task in tasks if task["name"] == "merge-7")
    assert len(merge["dependencies"]) == 6 and all("render-7-tile-" in name for name in merge["dependencies"])
    assert tasks[-1]["dependencies"] == ["merge-7", "merge-8"]


def test_blocks_are_converted_and_joined():
    tasks = compiled("surfel_conversion", blocks=3, object_name="Suzanne", result="/o/s.blend", blendfile="/a.blend")
    assert lines(tasks)[1] == "--command surfels convert --block 2 --objects Suzanne --blocks 3 --out /o/s.blend"
    assert lines(tasks)[3] == "--command surfels merge --blocks 3 --out /o/s.blend"
    assert tasks[3]["dependencies"] == ["convert-1", "convert-2", "convert-3"]


def test_without_a_place_for_the_result_nothing_is_compiled():
    with pytest.raises(quickjs.JSException, match="choose an output folder"):
        compiled("surfel_frames", frames="1", **{**FRAMES, "output_pattern": ""})


@pytest.mark.parametrize("name", ["surfel_frames", "surfel_conversion"])
def test_settings_are_ones_that_flamenco_knows(name):
    job_type = json.loads(load(name).eval("JSON.stringify(JOB_TYPE)"))
    assert job_type["label"]
    for setting in job_type["settings"]:
        assert setting.keys() <= SETTING and setting["type"] in ("string", "int32", "float", "bool"), setting
        assert setting.get("visible", "visible") in ("visible", "hidden", "submission", "web")
        if "eval" in setting:
            compile(setting["eval"], name, "eval")


@pytest.mark.parametrize("name", ["surfel_frames", "surfel_conversion"])
def test_the_extension_takes_each_command_line(name):
    """The commands' own parser accepts each task's arguments. Only a process with Blender can import that parser."""
    commands = pytest.importorskip("splat_addon.blender.commands")
    settings = {**FRAMES, "frames": "1-3", "blocks": 2, "object_name": "a", "result": "/r.blend", "tile_columns": 2}
    for task in compiled(name, **settings):
        arguments = task["commands"][0]["parameters"]["args"]
        assert arguments[:2] == ["--command", commands.NAME]
        assert isinstance(commands._parser().parse_args(arguments[2:]), argparse.Namespace)
