// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type of Flamenco: frames in chunks, or each frame in tiles that a task of its own puts together.
// To install it, copy this file into the folder `scripts` beside flamenco-manager; docs/farm.md tells more.

const JOB_TYPE = {
    label: "Surfel Splatting Frames",
    settings: [
        {
            key: "frames", type: "string", required: true,
            eval: "f'{C.scene.frame_start}-{C.scene.frame_end}'",
            evalInfo: { showLinkButton: true, description: "All frames of the scene" },
            description: "Which frames, like 47 or 1-30 or 3,5-10",
        },
        {
            key: "chunk_size", type: "int32", default: 10, propargs: { min: 1 }, visible: "submission",
            description: "Frames that a worker draws in one go; of frames in tiles, always one",
        },
        {
            key: "tile_columns", type: "int32", default: 1, propargs: { min: 1, max: 64 }, visible: "submission",
            description: "Tiles side by side in each frame; with 1 column and 1 row, frames are drawn whole",
        },
        {
            key: "tile_rows", type: "int32", default: 1, propargs: { min: 1, max: 64 }, visible: "submission",
            description: "Tiles above one another in each frame",
        },
        {
            key: "output_folder", type: "string", subtype: "dir_path", required: true, visible: "submission",
            description: "Folder that all workers can write to; each job gets one of its own in it",
        },
        {
            key: "output_pattern", type: "string", subtype: "file_path", editable: false,
            eval: "str(Path(abspath(settings.output_folder), jobname, 'frame_######'))",
            description: "Where the pictures go, with # for the number; the file's own format gives the ending",
        },
        { key: "blendfile", type: "string", required: true, visible: "web", description: "The file to render" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    if (!settings.output_pattern) {
        throw "The job has no output_pattern: choose an output folder.";
    }
    const isTiled = settings.tile_columns > 1 || settings.tile_rows > 1;
    const finished = isTiled ? addTiledFrames(job, settings) : addChunks(job, settings);

    // Flamenco knows a task's end by its exit code alone: this one fails where a frame is missing.
    const check = surfelsTask("check", settings, ["merge", "--frames", settings.frames]);
    for (const task of finished) {
        check.addDependency(task);
    }
    job.addTask(check);
}

// Gives the tasks after which all frames are there.
function addChunks(job, settings) {
    const tasks = [];
    for (const frames of frameChunker(settings.frames, settings.chunk_size)) {
        const task = surfelsTask("render-" + frames, settings, ["render", "--frames", frames]);
        job.addTask(task);
        tasks.push(task);
    }
    return tasks;
}

function addTiledFrames(job, settings) {
    const tiles = settings.tile_columns + "x" + settings.tile_rows;
    const merges = [];
    for (const frame of frameChunker(settings.frames, 1)) {
        const merge = surfelsTask("merge-" + frame, settings, ["merge", "--frames", frame, "--tiles", tiles]);
        for (let row = 1; row <= settings.tile_rows; row++) {
            for (let column = 1; column <= settings.tile_columns; column++) {
                const tile = column + "," + row;
                const render = surfelsTask(
                    "render-" + frame + "-tile-" + column + "-" + row,
                    settings,
                    ["render", "--frames", frame, "--tiles", tiles, "--tile", tile]
                );
                job.addTask(render);
                merge.addDependency(render);
            }
        }
        job.addTask(merge);
        merges.push(merge);
    }
    return merges;
}

// A task of one command of the extension.
function surfelsTask(name, settings, commandLine) {
    const task = author.Task(name, "blender");
    task.addCommand(author.Command("blender-render", {
        exe: "{blender}",
        exeArgs: "{blenderArgs}",
        argsBefore: ["--background"],
        blendfile: settings.blendfile,
        args: ["--command", "surfels"].concat(commandLine, ["--out", settings.output_pattern]),
    }));
    return task;
}
