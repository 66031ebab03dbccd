# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes small files of scans, for the fuzzer and for tests of the readers."""
