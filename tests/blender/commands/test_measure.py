# SPDX-License-Identifier: GPL-3.0-or-later
"""`surfels measure` prints a table of what settings cost and gain, and writes it as a page."""

import json


def test_the_command_prints_and_writes_the_table(animation, surfels_command, tmp_path):
    code, said = surfels_command("measure", "--out", f"{tmp_path}/", "--pictures", 8, "--json", "--error", 0.05)
    assert code == 0 and (tmp_path / "anim.html").stat().st_size > 10_000
    rows = [json.loads(line) for line in said.splitlines() if line.startswith("{")]
    assert rows[0]["settings"] == "As set" and all(row["seconds"] > 0 for row in rows)
    assert "FLIP 0.0" in said.splitlines()[-2]
