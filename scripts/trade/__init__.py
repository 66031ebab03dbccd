# SPDX-License-Identifier: GPL-3.0-or-later
"""The trade of speed for accuracy: cases x choices -> rows -> table, plots, pictures.

`cases`: what is drawn. `choices`: how. `truth`: the float64 pictures and how far a frame is from them. `measurement`:
frames turn by turn. `report`, `plots`, `pictures`: what is left in the folder. Started by scripts/measure.py.
"""
