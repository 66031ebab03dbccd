# SPDX-License-Identifier: GPL-3.0-or-later
"""Shadow maps before anything is drawn: which are needed, what casts into them, and what looks them up."""
