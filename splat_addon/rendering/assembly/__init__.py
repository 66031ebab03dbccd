# SPDX-License-Identifier: GPL-3.0-or-later
"""One frame from several pictures: from samples, from the faces of a panorama, or from parts of several machines."""
