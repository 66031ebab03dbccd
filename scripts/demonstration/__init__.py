# SPDX-License-Identifier: GPL-3.0-or-later
"""What scripts/demo.py runs inside Blender: models are read, converted, lit, framed and rendered."""
