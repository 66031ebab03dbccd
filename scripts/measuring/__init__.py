# SPDX-License-Identifier: GPL-3.0-or-later
"""Modules that scripts/bench and scripts/figures share.

`registry` lists what can be run, and `__main__` runs one of them. `timing` runs competing jobs alternately, and
`drawing` does so for pictures. `report` prints the results and writes them to a folder. `devices` runs a job where a
device can be opened. `models` and `blender_scene` provide scenes.
"""
