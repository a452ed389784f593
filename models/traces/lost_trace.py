"""Empty trace in the place of a run that was lost."""

from __future__ import annotations

import math

import numpy as np

from ..case import Case, Run
from ..diagnostic import Diagnostic
from .trace import Trace
from .trace_source import Known


def lost_trace(case: Case, run: Run, why: str) -> Trace:
    """Return the trace of a run that left none, as where its process died: no samples, outcome "failed"."""
    none = np.empty(0)
    return Trace(
        case=case,
        run=run,
        version="",
        time=none,
        tilt=none,
        tilt_rate=none,
        rolling_angle=none,
        twist=none,
        contact_point=np.empty((0, 2)),
        centre_of_mass=np.empty((0, 3)),
        peak_tilt=math.nan,
        outcome="failed",
        uplift_time=math.nan,
        uplift_direction=math.nan,
        source=Known({}),
        facts=(Diagnostic(code="died", detail=why),),
    )
