"""The physical checks, in groups, and their order: what comes later rests on what comes earlier."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from rockwobble.models.number_checks import require_one_of

from . import agreement, baseline, conserved, equations, exact, invariance, order, protocol, rest, trace
from .result import Bound, Result, at_most, not_run
from .subject import Subject

Measure = Callable[[Subject, str], Iterator[Result]]
BOTH = ("recess", "flat")
MODELS = ("recess", "flat", "planar")
_ENDS = Bound(0.0, "a check must reach its end")


@dataclass(frozen=True, slots=True, kw_only=True)
class Check:
    """One check, and the subjects that it is for.

    Parameters
    ----------
    measure : callable
        Yields the results on a subject with a support; its docstring holds the theory and the expected law.
    supports : tuple of str
        Supports that it is for, as far as the subject has them; empty: the first of the subject.
    knows : tuple of str
        Fields of a trace without which it cannot run, and says so.
    options : tuple of str
        Options of the source without which it does not apply.
    reference : bool
        Whether it compares with an independent model: not for the reduced models themselves.
    files : bool
        Whether it is for trajectories of cases of their own.
    from_rest : bool
        Whether it starts from a cylinder that stands.
    slab : bool
        Whether it is for subjects that know a wobbling frame.
    extra : bool
        Whether it runs for an engine that is an extra where no engine is named.
    """

    measure: Measure
    supports: tuple[str, ...] = BOTH
    knows: tuple[str, ...] = ()
    options: tuple[str, ...] = ()
    reference: bool = False
    files: bool = False
    from_rest: bool = False
    slab: bool = False
    extra: bool = False

    def applies(self, subject: Subject) -> bool:
        """Return whether it is a question to this subject at all."""
        return (
            set(self.options) <= subject.options
            and self.files == (subject.cases is not None)
            and (subject.reference is not None or not self.reference)
            and (subject.uplifts or not self.from_rest)
            and (subject.carries_slab or not self.slab)
        )

    def run(self, subject: Subject, *, brief: bool = False) -> Iterator[Result]:
        """Yield its results, the name of each with its support; an exception is a result, too.

        Of a `brief` run, those of the first support alone.
        """
        name = self.measure.__name__.replace("_", " ")
        if lacks := [field for field in self.knows if field not in subject.knows]:
            yield not_run(name, f"{subject.label} does not return {', '.join(lacks)}")
            return
        supports = [each for each in self.supports or subject.supports[:1] if each in subject.supports]
        for support in supports[:1] if brief else supports:
            try:
                for result in self.measure(subject, support):
                    yield dataclasses.replace(result, name=f"{result.name}, {support}")
            except Exception as error:  # whatever a model or engine raises is said in its place
                words = f"{type(error).__name__}: {' '.join(str(error).split())}"
                if subject.options or subject.cases:  # ours, or read here: it must not
                    yield at_most(f"{name}, {support}", math.nan, _ENDS, note=words)
                else:
                    yield not_run(f"{name}, {support}", words)


def _of_rest(measure: Measure) -> Check:
    return Check(measure=measure, supports=MODELS, options=("rest_tilt",))


GROUPS: Mapping[str, tuple[Check, ...]] = {
    "equations": (Check(measure=equations.residual, supports=("recess",), options=("rtol",)),),
    "exact": (
        Check(measure=exact.free_response, supports=("recess",)),
        Check(measure=exact.steady_wobble),
        Check(measure=exact.vanishing_spin, supports=("recess",), options=("rtol",)),
        Check(measure=exact.planar_rocking, supports=("planar",)),
    ),
    "conserved": (
        Check(measure=conserved.free_motion, knows=("energy",)),
        Check(measure=conserved.work_of_the_ground, knows=("energy", "centre_of_mass")),
        Check(measure=conserved.work_of_a_record, supports=MODELS, knows=("energy",), options=("rtol",)),
    ),
    "rest": (
        Check(measure=rest.stands, supports=MODELS, from_rest=True),
        Check(measure=rest.uplift, knows=("uplift_time",), from_rest=True),
        Check(measure=rest.after_uplift, options=("rtol",)),
        Check(measure=rest.force_at_rest, knows=("contact_force",), from_rest=True),
        Check(measure=rest.falls, knows=("outcome",)),
        Check(measure=rest.landing, supports=("planar",), options=("restitution",)),
        Check(measure=rest.static_loads, supports=(), options=("stepper",), from_rest=True),
    ),
    "invariance": (
        Check(measure=invariance.frame, knows=("rolling_angle",)),
        Check(measure=invariance.scale),
        Check(measure=invariance.statement),
        _of_rest(invariance.falling_ground),
        _of_rest(invariance.after_rest),
        Check(measure=invariance.backwards, supports=("recess",), options=("rtol",)),
    ),
    "order": (
        Check(measure=order.tolerance, options=("rtol",)),
        Check(measure=order.time_step, options=("stepper",), reference=True),
    ),
    "trace": (
        Check(measure=trace.place, supports=("recess",), knows=("twist", "contact_point", "centre_of_mass")),
        Check(measure=trace.slip, options=("stepper",)),
        Check(measure=trace.turning, knows=("extrema", "passes")),
    ),
    "agreement": (
        Check(measure=agreement.fields, knows=("twist", "centre_of_mass"), reference=True, extra=True),
        Check(measure=agreement.release, reference=True),
        Check(measure=agreement.frame, reference=True, slab=True),
        Check(measure=agreement.ramp, reference=True, from_rest=True),
        Check(measure=agreement.record, reference=True, from_rest=True),
        Check(measure=agreement.ring, supports=("ring",), options=("stepper",), reference=True),
        Check(measure=agreement.trajectory, reference=True, files=True),
    ),
    "protocol": tuple(
        Check(measure=measure, supports=(*BOTH, "ring"), options=("stepper",))
        for measure in (protocol.description, protocol.stepping, protocol.time_grid, protocol.repetition)
    ),
    "baseline": (
        Check(measure=baseline.kept_numbers, supports=MODELS, options=("rtol",)),
        Check(measure=baseline.kept_numbers, supports=(*BOTH, "ring"), options=("stepper",)),
    ),
}
TITLES = {
    "equations": "equations of motion",
    "exact": "exact solutions",
    "conserved": "conserved quantities",
    "rest": "rest and uplift",
    "invariance": "invariance",
    "order": "order of convergence",
    "trace": "consistency of a trace",
    "agreement": "agreement with the independent model",
    "protocol": "protocol of an engine",
    "baseline": "baseline",
}


def run_checks(
    subject: Subject, groups: Sequence[str] | None = None, *, extra: bool = False
) -> Iterator[Result]:
    """Yield the results of the groups, in their order, as they are made.

    An exception in a check is a failure of that check, or, of somebody's model, one that could not run: the
    checks after it still run.

    Parameters
    ----------
    subject : Subject
    groups : sequence of str, optional
        Some of `GROUPS`. Default: all.
    extra : bool, optional
        Only the checks of an engine that is an extra and that nobody has named.

    Returns
    -------
    iterator of Result

    Raises
    ------
    ValueError
        If a group is unknown.
    """
    for group in groups or ():
        require_one_of("a group", group, tuple(GROUPS))
    for group, checks in GROUPS.items():
        if groups is not None and group not in groups:
            continue
        for check in checks:
            if check.applies(subject) and (check.extra or not extra):
                for result in check.run(subject, brief=extra):
                    yield dataclasses.replace(result, group=group, subject=subject.label)
