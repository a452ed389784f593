"""Subjects of the checks with one fault."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

from rockwobble.compare.check import Subject
from rockwobble.models import Case, GroundMotion, Trace, WobblingFrame
from rockwobble.models.trace_file import EagerSource

Faulty = Callable[[Subject], Subject]


def asked(change: Callable[[Case], Case]) -> Faulty:
    """Subject that runs another case than asked."""

    def faulty(right: Subject) -> Subject:
        def source(case: Case, support: str, **options: Any) -> Trace:
            return right.source(change(case), support, **options)

        return dataclasses.replace(right, source=source)

    return faulty


def answered(change: Callable[[Trace], Trace]) -> Faulty:
    """Subject with a changed trace."""

    def faulty(right: Subject) -> Subject:
        def source(*given: Any, **options: Any) -> Trace:
            return change(right.source(*given, **options))

        return dataclasses.replace(right, source=source)

    return faulty


def moved(change: Callable[[GroundMotion], GroundMotion]) -> Faulty:
    """Subject with a changed ground motion."""

    def other(case: Case) -> Case:
        motion = None if case.motion is None else change(case.motion)
        return dataclasses.replace(case, motion=motion, duration=case.length)

    return asked(other)


def field(name: str, change: Callable[[Any], Any]) -> Faulty:
    """Subject with another value of one field of the trace."""

    def other(trace: Trace) -> Trace:
        value = change(getattr(trace, name))
        if name in trace.late:
            return dataclasses.replace(trace, source=EagerSource({**trace.late, name: value}))
        return dataclasses.replace(trace, **{name: value})

    return answered(other)


def larger(case: Case, size: float = 1.001) -> Case:
    """Problem of a body, or of columns, larger by a factor."""
    body = case.cylinder
    column = body.cylinder if isinstance(body, WobblingFrame) else body
    column = dataclasses.replace(column, semidiagonal=size * column.semidiagonal)
    if isinstance(body, WobblingFrame):
        column = WobblingFrame(column, body.slab_mass_ratio, body.columns)
    return dataclasses.replace(case, cylinder=column)
