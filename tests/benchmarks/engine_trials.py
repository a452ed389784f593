"""Trials that take one thing of an engine to its extreme: see `engine_extremes`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rockwobble import multibody
from rockwobble.models import GroundMotion

_LENGTH = 2.0  # [s]


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """One run at an extreme; arguments of `multibody.simulate` that are not its defaults.

    Parameters
    ----------
    extreme, value : str
        What is extreme, and how much.
    engine, support : str
    tan_alpha, tilt, rate, length : float
        Of the release: tilt in alpha, rolling rate [rad/s], duration [s]; tilt 0 stands.
    motion : GroundMotion, optional
    arguments : dict
        Friction, time step and settings.
    """

    extreme: str
    value: str
    engine: str
    support: str
    tan_alpha: float = 0.2
    tilt: float = 0.5
    rate: float = 0.5
    length: float = _LENGTH
    motion: GroundMotion | None = None
    arguments: dict[str, Any] = field(default_factory=dict)


def trials(engines: Sequence[str] | None = None) -> list[Trial]:
    """Return all trials of the engines that are installed, each of their supports."""
    known = ("mujoco", "pybullet") if engines is None else engines
    installed = [engine for engine in known if engine in multibody.available_engines()]
    found = [
        trial for engine in installed for support in ("recess", "flat") for trial in _of(engine, support)
    ]
    return found + (_rings() if "mujoco" in installed else [])


def _rings() -> list[Trial]:
    def trial(extreme: str, value: Any, **given: Any) -> Trial:
        arguments = {"friction": 3.0} | given.pop("arguments", {})
        return Trial(
            extreme=f"ring, {extreme}",
            value=f"{value:g}",
            engine="mujoco",
            support="ring",
            arguments=arguments,
            **given,
        )

    found = []
    for tan_alpha in (0.2, 1.0, 3.0):
        found += [
            trial("time step [s]", step, tan_alpha=tan_alpha, length=length, arguments={"time_step": step})
            for step, length in ((1e-6, 0.05), (5e-4, 2.0), (1e-3, 4.0))
        ]
        found += [
            trial("contact time constant [h]", part, tan_alpha=tan_alpha,
                  arguments={"contact_time_constant": part * 1e-4})
            for part in (0.5, 1.0, 100.0, 1e3)
        ]  # fmt: skip
        found += [
            trial(name, value, tan_alpha=tan_alpha, arguments={name.replace(" ", "_"): value})
            for name, value in (
                ("contact damping ratio", 0.01), ("contact damping ratio", 10.0), ("friction", 0.0),
                ("ring friction", 0.0), ("ring friction", 10.0), ("ring facets", 3),
            )
        ]  # fmt: skip
        found += [trial("spin [rad/s]", rate, tan_alpha=tan_alpha, rate=rate) for rate in (3.0, 30.0)]
        found += [
            trial("shaking [g]", peak, tan_alpha=tan_alpha, tilt=0.0, motion=_shaking(peak),
                  arguments={"friction": 5.0, **walls})
            for peak in (3.0, 10.0)
            for walls in ({}, {"ring_clearance": 0.0, "ring_inclination": 0.0})
        ]  # fmt: skip
    return found


def _of(engine: str, support: str) -> list[Trial]:
    def trial(extreme: str, value: Any, **given: Any) -> Trial:
        text = value if isinstance(value, str) else f"{value:g}"
        return Trial(extreme=extreme, value=text, engine=engine, support=support, **given)

    found = [
        trial("time step [s]", step, length=length, arguments={"time_step": step})
        for step, length in (
            (1e-6, 0.1), (1e-5, 1.0), (2e-4, 2.0), (5e-4, 2.0), (1e-3, 4.0), (2e-3, 4.0), (1e-2, 4.0),
        )
    ]  # fmt: skip
    found += [
        trial("friction", mu, tan_alpha=tan_alpha, arguments={"friction": mu})
        for mu in (0.0, 1e-3, 0.05, 0.2, 1.0, 10.0)
        for tan_alpha in (0.2, 3.0)
    ]
    found += [trial("tan alpha", each, tan_alpha=each) for each in (0.05, 0.5, 1.5, 3.0, 10.0)]
    found += [trial("tan alpha, spinning", each, tan_alpha=each, rate=3.0) for each in (0.05, 1.0, 10.0)]
    found += [
        trial("spin [rad/s]", rate, rate=rate, length=length)
        for rate, length in (
            (0.0, 2.0), (1e-9, 2.0), (1e-4, 2.0), (3.0, 2.0), (10.0, 1.0), (100.0, 0.2), (1e3, 0.1),
        )
    ]  # fmt: skip
    found += [trial("tilt [alpha]", tilt, tilt=tilt, length=4.0) for tilt in (1e-4, 0.01, 0.95, 1.0, 1.5)]
    found += [trial("shaking [g]", peak, tilt=0.0, motion=_shaking(peak)) for peak in (0.21, 1.0, 10.0)]
    steep = [(0.2, 10.0), (3.0, 10.0)]
    found += [
        trial("shaking [g], squat", peak, tan_alpha=tan_alpha, tilt=0.0, motion=_shaking(peak),
              arguments={"friction": 5.0})
        for tan_alpha, peak in steep
    ]  # fmt: skip
    if support == "recess":
        # h sqrt(2 k) of the twist, over its limit of stability from about 1 on
        found += [
            trial("guide, h sqrt(k)", part, tan_alpha=tan_alpha,
                  arguments={"guide_stiffness": (part / 1e-4) ** 2})
            for part in (1e-6, 1e-4, 1e-2, 0.1, 0.3, 0.5, 0.7, 1.0, 3.0, 1e3)
            for tan_alpha in (0.2, 3.0)
        ]  # fmt: skip
    return found + (_mujoco(trial) if engine == "mujoco" else _pybullet(trial))


def _mujoco(trial: Callable[..., Trial]) -> list[Trial]:
    found = [
        trial("contact time constant [h]", part, tan_alpha=tan_alpha,
              arguments={"contact_time_constant": part * 1e-4})
        for part in (0.1, 0.5, 1.0, 10.0, 100.0, 1e3, 1e4)
        for tan_alpha in (0.2, 3.0)
    ]  # fmt: skip
    found += [
        trial("contact damping ratio", ratio, rate=rate, arguments={"contact_damping_ratio": ratio})
        for ratio in (1e-3, 0.01, 0.1, 0.3, 3.0, 30.0)
        for rate in (0.01, 0.5)
    ]
    settings: list[tuple[str, str, Any]] = [
        *(("impedance", "impedance", value) for value in (0.01, 0.5, 0.9)),
        *(("friction damping", "friction_damping", value) for value in (1e-3, 0.1, 0.5, 2.0)),
        *(("integrator", "integrator", value) for value in ("implicitfast", "implicit", "RK4", "discrete")),
        *(("iterations", "iterations", value) for value in (1, 2)),
        ("solver tolerance", "tolerance", 1e-3),
        ("cone", "cone", "pyramidal"),
    ]
    found += [
        trial(what, value, tan_alpha=tan_alpha, arguments={name: value})
        for what, name, value in settings
        for tan_alpha in (0.2, 1.0)
    ]
    corners = [
        trial("standing corners", n, tilt=0.0, motion=_shaking(0.5), arguments={"standing_corners": n})
        for n in (0, 4, 8)
    ]
    return found + corners


def _pybullet(trial: Callable[..., Trial]) -> list[Trial]:
    settings = [
        *(("contact erp", "contact_erp", value) for value in (1e-4, 0.01, 1.0)),
        *(("contact slop", "contact_slop", value) for value in (1e-4, 1e-2)),
        *(("collision margin", "collision_margin", value) for value in (1e-3, 0.04)),
        *(("solver residual", "solver_residual", value) for value in (1e-7, 1e-3, 1.0)),
        *(("iterations", "iterations", value) for value in (1, 2, 5)),
        *(("friction damping", "friction_damping", value) for value in (1e-3, 0.5, 2.0)),
    ]
    return [
        trial(what, value, tan_alpha=tan_alpha, arguments={name: value})
        for what, name, value in settings
        for tan_alpha in (0.2, 1.0)
    ]


def _shaking(peak: float) -> GroundMotion:
    """Two seconds of two sines, of `peak` times 9.81 m/s^2."""
    time = np.arange(0.0, 2.0001, 0.01)
    wave = np.column_stack([np.sin(6.0 * time), 0.6 * np.cos(5.0 * time) * np.minimum(1.0, 4.0 * time)])
    motion = GroundMotion(wave, 0.01)
    return motion.scaled(9.81 * peak / motion.peak)
