"""Layer equations: whether the motion that the reduced model computes solves the equations of the paper.

Nothing that the model says of itself is used but positions at samples; their differences go into
Lagrange's equations (`lagrange`), and into (18) and (19) term by term. There every coefficient is fitted
to the motion on its own, so that a wrong one is named.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from types import ModuleType

import numpy as np

from rockwobble.models import Cylinder

from ..bench import Array, Bench, largest
from ..finding import Bound, Finding, at_most, worst_of
from ..problems import GRAVITY
from . import lagrange
from .lagrange import Shape
from .short_motions import CYLINDERS, FailedMotionError, Sampled, sample

Terms = Mapping[str, tuple[Array, float]]

REST_OF = "differences of positions known to rounding"
# 1e-16/0.02^2 of the angles, 1e-11 of p^2 at the worst, and what rtol 1e-13 leaves in a dozen steps
RESIDUAL = Bound(1e-9, REST_OF, "of g (b + h)")
RATE = Bound(1e-9, REST_OF, "of p")
FORCE = Bound(1e-9, "second differences of the mass centre", "weights")
MOMENT = Bound(1e-9, "second differences of positions", "of weight times b")
# the same through the fit, whose condition number is up to a hundred
COEFFICIENT = Bound(1e-7, "each coefficient fitted to differences of computed positions")
WRITTEN = Bound(1e-12, "derivatives of the energies by complex steps")
STATES = 24
ENDS = Bound(0.0, "a third of a swing, far from upright")


def check(bench: Bench) -> Iterator[Finding]:
    """Yield the findings of this layer, each the worst over all cylinders."""
    try:
        motions = {name: sample(bench, cylinder) for name, cylinder in CYLINDERS.items()}
    except FailedMotionError as error:
        part = "equation of motion (18) or (19), or step control"
        yield at_most("short motions reach their end", math.nan, ENDS, part, str(error))
        return
    coefficients = [
        *_coefficients("(18)", {name: _terms_18(motion) for name, motion in motions.items()}),
        *_coefficients("(19)", {name: _terms_19(motion) for name, motion in motions.items()}),
    ]
    if any(finding.failed for finding in coefficients):
        # one that is wrong makes others look a little wrong: the worst comes first
        coefficients.sort(key=lambda finding: -finding.value if math.isfinite(finding.value) else -math.inf)
    yield from coefficients
    left = {name: _lagrange(motion) for name, motion in motions.items()}
    for angle, part in enumerate(("tilt", "rolling angle")):
        yield worst_of(
            f"Lagrange's equation for the {part}",
            {name: each[angle] for name, each in left.items()},
            RESIDUAL,
            f"equation of motion of the {part}, or how the record reaches it",
        )
    rates = {name: largest(m.theta_rate - m.stated_rate) / m.p for name, m in motions.items()}
    yield worst_of("tilt rate against the change of tilt", rates, RATE, "tilt rate")
    newton = {name: _newton(motion) for name, motion in motions.items()}
    part = "contact force (reduced/forces.py), or positions of the mass centre"
    yield worst_of("contact force against Newton's law", newton, FORCE, part)
    euler = {name: _euler(motion) for name, motion in motions.items()}
    part = "restraining moment (reduced/forces.py)"
    yield worst_of("restraining moment against Euler's law", euler, MOMENT, part)
    if isinstance(bench.reduced, ModuleType):  # a model from outside shows its motion alone
        written = {name: _written(bench.reduced, cylinder) for name, cylinder in CYLINDERS.items()}
        for place, quantity in enumerate(("theta''", "phi'", "L'")):
            yield worst_of(
                f"{quantity} of recess_rhs against Lagrange's equations",
                {name: each[place] for name, each in written.items()},
                WRITTEN,
                "equations (18) and (19) as written (reduced/equations.py)",
            )


def _lagrange(motion: Sampled) -> tuple[float, float]:
    place, rates = (motion.theta, motion.phi), (motion.theta_rate, motion.phi_rate)
    curves = (motion.theta_curve, motion.phi_curve)
    by_tilt, by_turn = lagrange.residuals(motion.shape, place, rates, curves, motion.ground)
    scale = motion.shape.g * (motion.shape.b + motion.shape.h)
    return largest(by_tilt) / scale, largest(by_turn) / scale


def _newton(motion: Sampled) -> float:
    return largest(_needed_force(motion) / motion.shape.g - motion.stated_force)


def _euler(motion: Sampled) -> float:
    place, rates = (motion.theta, motion.phi), (motion.theta_rate, motion.phi_rate)
    curves = (motion.theta_curve, motion.phi_curve)
    kappa = lagrange.restraining(motion.shape, place, rates, curves, _needed_force(motion))
    return largest(kappa / motion.shape.g - motion.stated_moment) / motion.shape.b


def _needed_force(motion: Sampled) -> Array:
    return np.asarray(motion.centre_curve + motion.ground + [0.0, 0.0, motion.shape.g])


def _written(reduced: ModuleType, cylinder: Cylinder) -> tuple[float, float, float]:
    """Errors of theta'', phi' and L' of the equations as written, relative to their largest.

    Runs do not show them: the Taylor series of the recess model has the same equations as recurrences.
    """
    shape, body = lagrange.shape_of(cylinder), reduced.body.body_of(cylinder, GRAVITY)
    drawn = np.random.default_rng(19)
    theta, phi = drawn.uniform(0.05, 1.2, STATES), drawn.uniform(-3.0, 3.0, STATES)
    tilt_rate, spin = drawn.normal(0.0, body.p, (2, STATES))
    ground = drawn.normal(0.0, 0.3 * GRAVITY, (STATES, 3))
    by_tilt, momentum = lagrange.momenta(shape, theta, phi, tilt_rate, spin)
    needed = lagrange.forces(shape, theta, phi, tilt_rate, spin, ground)
    states = zip(theta, tilt_rate, phi, momentum, *ground.T, strict=True)
    found = np.array([reduced.equations.recess_rhs(body, *state) for state in states]).T
    # the momentum of the tilt is theta' times a constant
    expected = needed[0] * tilt_rate / by_tilt, spin, needed[1]
    errors = [largest(a - b) / largest(b) for a, b in zip(found[1:], expected, strict=True)]
    return errors[0], errors[1], errors[2]


def _coefficients(equation: str, terms: Mapping[str, Terms]) -> Iterator[Finding]:
    errors = {name: _errors(of_one) for name, of_one in terms.items()}
    for term in next(iter(errors.values())):
        found = {name: of_one[term] for name, of_one in errors.items()}
        off = [f"{100.0 * error:+.2g} %" for error in found.values() if abs(error) > COEFFICIENT.most]
        note = f"off by {', '.join(off)}" if off else ""
        part = f"coefficient of {equation}: {term}"
        yield worst_of(f"{equation}: {term}", found, COEFFICIENT, part, note)


def _errors(terms: Terms) -> dict[str, float]:
    """Return by how much each coefficient is off, relative to its size.

    The equation fixes them but for a common factor, which is chosen so that most are right.
    """
    columns = np.column_stack([values * coefficient for values, coefficient in terms.values()])
    if not np.isfinite(columns).all():
        return dict.fromkeys(terms, math.nan)
    scale = np.linalg.norm(columns, axis=0)
    # the combination of the columns that is nearest to zero
    _, _, directions = np.linalg.svd(columns / scale, full_matrices=False)
    factors = directions[-1] / scale
    errors = factors / np.median(factors) - 1.0
    return dict(zip(terms, errors.tolist(), strict=True))


def _terms_18(motion: Sampled) -> Terms:
    k, s, c, a_r, _ = _parts(motion)
    weight, spin2 = k.g + motion.ground[:, 2], motion.phi_rate**2
    return {
        "I1 + h^2 + b^2 of theta''": (motion.theta_curve, k.I1 + k.h**2 + k.b**2),
        "b of (g + az) cos": (c * weight, k.b),
        "-h of (g + az) sin": (s * weight, -k.h),
        "I2 - I1 + b^2 - h^2 of sin cos phi'^2": (s * c * spin2, k.I2 - k.I1 + k.b**2 - k.h**2),
        "-(I2 + b^2) of sin phi'^2": (s * spin2, -(k.I2 + k.b**2)),
        "-h b of (1 + cos) phi'^2": ((1.0 + c) * spin2, -k.h * k.b),
        "2 h b of cos^2 phi'^2": (c * c * spin2, 2.0 * k.h * k.b),
        "h of cos a_r": (c * a_r, k.h),
        "b of sin a_r": (s * a_r, k.b),
    }


def _terms_19(motion: Sampled) -> Terms:
    k, s, c, _, a_t = _parts(motion)
    curve, both = motion.phi_curve, motion.phi_rate * motion.theta_rate
    return {
        "I1 - I2 + h^2 - b^2 of sin^2 phi''": (s * s * curve, k.I1 - k.I2 + k.h**2 - k.b**2),
        "2 (I2 + b^2) of (1 - cos) phi''": ((1.0 - c) * curve, 2.0 * (k.I2 + k.b**2)),
        "2 h b of sin (1 - cos) phi''": (s * (1.0 - c) * curve, 2.0 * k.h * k.b),
        "2 (I2 - I1 - h^2 + b^2) of sin (1 - cos) theta' phi'": (
            s * (1.0 - c) * both,
            2.0 * (k.I2 - k.I1 - k.h**2 + k.b**2),
        ),
        "2 h b of (2 sin^2 + cos - 1) theta' phi'": ((2.0 * s * s + c - 1.0) * both, 2.0 * k.h * k.b),
        "2 (I1 + h^2) of sin theta' phi'": (s * both, 2.0 * (k.I1 + k.h**2)),
        "b of (1 - cos) a_t": ((1.0 - c) * a_t, k.b),
        "h of sin a_t": (s * a_t, k.h),
    }


def _parts(motion: Sampled) -> tuple[Shape, Array, Array, Array, Array]:
    """Constants, sine and cosine of the tilt, and the ground's acceleration along and across the contact."""
    cos, sin = np.cos(motion.phi), np.sin(motion.phi)
    ax, ay = motion.ground[:, 0], motion.ground[:, 1]
    along, across = ax * cos + ay * sin, ay * cos - ax * sin
    return motion.shape, np.sin(motion.theta), np.cos(motion.theta), along, across
