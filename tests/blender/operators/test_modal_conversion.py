# SPDX-License-Identifier: GPL-3.0-or-later
"""A conversion from a button goes on source by source, and Esc ends it before the next one."""

from types import SimpleNamespace

import pytest

from splat_addon.blender.operators import modal_conversion


class Batch:
    """Two sources, which take no time."""

    has_sources, has_surfels, is_cancelled, share, refused = True, False, False, 0.5, ()

    def __init__(self):
        self.sampled = []

    def prepared(self, context):
        yield from "ab"

    def sample(self, source):
        self.sampled.append(source)

    def status(self):
        return "half"


class Operator(modal_conversion.ModalConversion):
    """The mix-in as Blender runs it from a button."""

    def __init__(self):
        self.batch, self.finished = Batch(), []

    def _new_batch(self, context):
        return self.batch

    def _finish(self, context, batch):
        self.finished.append(batch)
        return {"CANCELLED" if batch.is_cancelled else "FINISHED"}


@pytest.mark.parametrize("is_pressed", [False, True])
def test_sources_are_sampled_in_turn_until_esc(is_pressed, monkeypatch):
    monkeypatch.setattr(modal_conversion, "bpy", SimpleNamespace(app=SimpleNamespace(background=False)))
    texts, timers = [], []
    manager = SimpleNamespace(event_timer_add=lambda *_, **__: timers.append(1) or 7)
    manager.modal_handler_add = manager.progress_update = manager.progress_begin = lambda *_: None
    manager.event_timer_remove, manager.progress_end = (lambda timer: timers.append(-timer)), lambda: None
    context = SimpleNamespace(window_manager=manager, window=None)
    context.workspace = SimpleNamespace(status_text_set=texts.append)
    operator = Operator()
    assert operator.invoke(context, None) == {"RUNNING_MODAL"}
    if is_pressed:
        operator.modal(context, SimpleNamespace(type="ESC"))
    while (ended := operator.modal(context, SimpleNamespace(type="TIMER"))) == {"RUNNING_MODAL"}:
        pass
    assert ended == ({"CANCELLED"} if is_pressed else {"FINISHED"}) and operator.finished == [operator.batch]
    assert operator.batch.sampled == ([] if is_pressed else ["a", "b"])
    assert timers == [1, -7] and texts[0] == "half" and texts[-1] is None
