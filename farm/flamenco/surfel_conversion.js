// SPDX-License-Identifier: GPL-3.0-or-later
//
// A job type of Flamenco: one object becomes surfels in blocks of the sampling grid, and a task joins them.
// To install it, copy this file into the folder `scripts` beside flamenco-manager; docs/farm.md tells more.

const JOB_TYPE = {
    label: "Surfel Splatting Conversion",
    settings: [
        {
            key: "object_name", type: "string", required: true,
            eval: "C.object.name if C.object else ''",
            evalInfo: { showLinkButton: true, description: "The active object" },
            description: "The object that becomes surfels, as densely as the sidebar says",
        },
        {
            key: "blocks", type: "int32", default: 16, propargs: { min: 1, max: 4096 }, visible: "submission",
            description: "Parts of the work: several a worker, for they are not all equally full",
        },
        {
            key: "output_folder", type: "string", subtype: "dir_path", required: true, visible: "submission",
            description: "Folder that all workers can write to; each job gets one of its own in it",
        },
        {
            key: "result", type: "string", subtype: "file_path", editable: false,
            eval: "str(Path(abspath(settings.output_folder), jobname, 'surfels.blend'))",
            description: "The new file",
        },
        { key: "blendfile", type: "string", required: true, visible: "web", description: "The file with the object" },
    ],
};

function compileJob(job) {
    const settings = job.settings;
    if (!settings.result) {
        throw "The job has no result: choose an output folder.";
    }
    const merge = surfelsTask("merge", settings, ["merge"]);
    for (let block = 1; block <= settings.blocks; block++) {
        const which = ["--block", String(block), "--objects", settings.object_name];
        const convert = surfelsTask("convert-" + block, settings, ["convert"].concat(which));
        job.addTask(convert);
        merge.addDependency(convert);
    }
    job.addTask(merge);
}

// A task of one command of the extension.
function surfelsTask(name, settings, commandLine) {
    const task = author.Task(name, "blender");
    const about = ["--blocks", String(settings.blocks), "--out", settings.result];
    task.addCommand(author.Command("blender-render", {
        exe: "{blender}",
        exeArgs: "{blenderArgs}",
        argsBefore: ["--background"],
        blendfile: settings.blendfile,
        args: ["--command", "surfels"].concat(commandLine, about),
    }));
    return task;
}
