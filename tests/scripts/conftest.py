# SPDX-License-Identifier: GPL-3.0-or-later
"""Lets the tests import the scripts as these import each other.

The scripts' folder is last on the path, because Python's own `test` must be found first.
"""

import json
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

SCRIPTS = Path(__file__).resolve().parents[2] / "scripts"
if str(SCRIPTS) not in sys.path:
    sys.path.append(str(SCRIPTS))


@pytest.fixture(scope="session")
def bench():
    """bench(name, arguments ...) -> the finished `scripts/bench.py NAME ARGUMENTS`, run by the tests' Python."""
    from environment.module import module_process

    def run(*arguments):
        return subprocess.run(**module_process(sys.executable, "measuring", *arguments), capture_output=True, text=True)

    return run


#: Runs several benches in one process, as `python -m measuring` runs each, and prints what came of them.
SEVERAL = """
import contextlib, io, json, sys
from measuring.__main__ import main
for arguments in json.loads(sys.argv[1]):
    out, err = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
        code = main(arguments)
    print(json.dumps({"returncode": code, "stdout": out.getvalue(), "stderr": err.getvalue()}))
"""


@pytest.fixture(scope="session")
def benches():
    """benches([name, arguments ...], ...) -> the finished runs, all in one process, which imports everything once."""
    from environment.module import module_process

    def run(*runs):
        given = json.dumps([[str(argument) for argument in arguments] for arguments in runs])
        command = [sys.executable, "-P", "-c", SEVERAL, given]
        environment = module_process(sys.executable, "measuring")["env"]
        done = subprocess.run(command, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return [SimpleNamespace(**json.loads(line)) for line in done.stdout.splitlines()]

    return run
