"""Refusal of a support or a case that an engine cannot run, before anything runs."""

from __future__ import annotations

from rockwobble.models import Case, WobblingFrame

from ..protocol import Engine


def require_able(engine: Engine, name: str, case: Case, support: str) -> None:
    """Check that the engine called `name` has the support and can start the case.

    Raises
    ------
    ValueError
        Saying what is allowed.
    """
    supports = engine.supports
    if support not in supports:
        allowed = f"one of {', '.join(supports)}" if len(supports) > 1 else supports[0]
        raise ValueError(f"support must be {allowed} in {name}, got {support!r}")
    if isinstance(case.cylinder, WobblingFrame) and case.cylinder.slab_mass_ratio > 0.0:
        if not engine.facts.carries_slab:
            raise ValueError(f"{name} has no scene of a frame, got {case.cylinder!r}")
        if case.cylinder.columns != 1:
            raise ValueError(
                f"columns must be 1 in {name}, a slab that only translates, got {case.cylinder.columns}"
            )
        if support == "ring":
            raise ValueError("support must be recess or flat under a slab, which has no walls, got 'ring'")
    if not engine.uplifts and (case.initial is None or case.initial.tilt == 0.0):
        raise ValueError(
            f"{name} cannot uplift a cylinder that stands: give a release with a tilt, got a start at rest"
        )
    if case.rolling_resistance and not engine.facts.rolling_friction:
        raise ValueError(
            f"{name} has no rolling friction: rolling_resistance must be 0, got {case.rolling_resistance!r} m"
        )
