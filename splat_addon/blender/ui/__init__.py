# SPDX-License-Identifier: GPL-3.0-or-later
"""The panels: the sidebar's tab, and the engine's in the properties editor."""
