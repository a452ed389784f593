"""The coefficients of the code, proved from the energies of the paper alone.

The paper's normalised forms (21), (22) and (24) carry misprints, so the code is held against nothing
printed but the positions (8), (10) and the energies (13), (15) and (17): Lagrange's equations follow,
and the compiled functions, run on symbols, must satisfy them identically. A coefficient that is one
percent off, or a sign, leaves a residual.

The angles enter through the tangents of their quarters, so that the sines and cosines of angles and of
half angles are rational, and with them every residual: it is zero if and only if its numerator,
expanded, has no term left.
"""

import types
from collections.abc import Callable
from typing import Any

import pytest
import sympy as sp

from rockwobble.reduced import body as body_module
from rockwobble.reduced import equations
from rockwobble.reduced.body import Body

time = sp.Symbol("time")
b, h, R, I1, I2, g, gamma = sp.symbols("b h R I1 I2 g gamma", positive=True)
theta, phi = sp.Function("theta")(time), sp.Function("phi")(time)
ground = [sp.Function(f"u_{axis}")(time) for axis in "xyz"]  # displacement
tilt, omega, azimuth, rate, L = sp.symbols("tilt omega azimuth rate L")  # theta, theta', phi, phi', B phi'
theta_2, phi_2, a_x, a_y, a_z = sp.symbols("theta_2 phi_2 a_x a_y a_z")  # second derivatives
STATE = (tilt, omega, azimuth, L, a_x, a_y, a_z)
QUARTER = {tilt: sp.Symbol("quarter_tilt"), azimuth: sp.Symbol("quarter_azimuth")}  # tangents


def energies(share: Any) -> tuple[Any, Any]:
    """Kinetic and potential energy per unit mass, from (8), (10), (13)-(15) and (17).

    Those of a slab of `share` masses are added, at the highest point of the top.
    """
    azimuthal = sp.rot_axis3(-phi)
    tilting = sp.rot_axis2(-theta)
    rotation = azimuthal * tilting * azimuthal.T  # (5), (6), where the third angle psi is -phi
    e_x, e_z = azimuthal[:, 0], sp.Matrix([0, 0, 1])
    base = b * (1 - sp.cos(theta)) * e_x + b * sp.sin(theta) * e_z  # (10)
    centre = sp.Matrix(ground) + base + h * rotation[:, 2]  # (11)
    velocity = centre.diff(time)
    # the circle on which the top rolls is fixed to the slab, as that of the base is to the ground
    highest = base + 2 * h * rotation[:, 2] - b * (sp.cos(theta) * e_x - sp.sin(theta) * e_z)
    slab = sp.Matrix(ground) + highest + b * e_x
    slab_velocity = slab.diff(time)
    spin = rotation.T * rotation.diff(time)  # skew: the angular velocity (14) in body axes
    # simplified before they are squared
    angular_velocity = sp.Matrix([reduced(each, phi, theta) for each in (spin[2, 1], spin[0, 2], spin[1, 0])])
    translation = velocity.dot(velocity) + share * slab_velocity.dot(slab_velocity)
    kinetic = (translation + angular_velocity.dot(sp.diag(I1, I1, I2) * angular_velocity)) / 2
    return reduced(kinetic, phi, theta), g * (centre[2] + share * slab[2])


def reduced(expression: Any, *angles: Any) -> Any:
    """Polynomial in sines and cosines with at most the first power of each cosine."""
    for angle in angles:
        s, c = sp.sin(angle), sp.cos(angle)
        expression = sp.rem(sp.expand(expression), s**2 + c**2 - 1, c)
    return sp.expand(expression)


def plain(expression: Any) -> Any:
    """Expression with symbols in place of functions of time; position and velocity of the ground cancel."""
    functions = (theta, phi, *ground)
    for order, symbols in (
        (2, (theta_2, phi_2, a_x, a_y, a_z)),
        (1, (omega, rate, 0, 0, 0)),
        (0, (tilt, azimuth, 0, 0, 0)),
    ):
        expression = expression.subs(
            {f.diff(time, order): x for f, x in zip(functions, symbols, strict=True)}
        )
    return expression


@pytest.fixture(scope="module", params=[0, gamma], ids=["cylinder", "frame"])
def share(request: pytest.FixtureRequest) -> Any:
    """Return the mass of the slab over that of the columns."""
    return request.param


@pytest.fixture(scope="module")
def paper(share: Any) -> tuple[Any, Any]:
    """Return the kinetic and the potential energy."""
    return energies(share)


@pytest.fixture(scope="module")
def motion(paper: tuple[Any, Any]) -> tuple[Any, Any]:
    """Left-hand sides of Lagrange's equations (12), for theta and for phi."""
    function = paper[0] - paper[1]
    tilting, turning = (
        plain((function.diff(angle.diff(time)).diff(time) - function.diff(angle)).doit())
        for angle in (theta, phi)
    )
    return reduced(tilting, azimuth, tilt), reduced(turning, azimuth, tilt)


def sin_cos(angle: Any) -> tuple[Any, Any]:
    """Sine and cosine of tilt, azimuth or half of one, as rational functions."""
    (symbol,) = angle.free_symbols
    x = QUARTER[symbol]
    s, c = 2 * x / (1 + x**2), (1 - x**2) / (1 + x**2)
    if rational(angle / symbol) == sp.Rational(1, 2):
        return s, c
    assert angle == symbol
    return 2 * s * c, c**2 - s**2


def on_symbols(function: Any) -> Callable[..., Any]:
    """Compiled function of the code, as a Python function of symbols."""
    original = getattr(function, "py_func", function)
    names = {
        **original.__globals__,
        "sin_cos": sin_cos,
        "sqrt": sp.sqrt,
        "math": types.SimpleNamespace(atan=sp.atan),
    }
    for part in {"recess_motion", "base_inertia", "restoring", "stored_energy"}.intersection(
        original.__code__.co_names
    ):
        names[part] = on_symbols(getattr(equations, part))
    run = types.FunctionType(original.__code__, names, argdefs=original.__defaults__)

    def exactly(*arguments: Any) -> Any:
        value = run(*arguments)
        if not isinstance(value, tuple):
            return rational(value)
        exact = map(rational, value)
        return Body._make(exact) if isinstance(value, Body) else tuple(exact)

    return exactly


def rational(expression: Any) -> Any:
    """Return an expression of the code with its literals as fractions."""
    return sp.nsimplify(expression, rational=True)


def vanishes(expression: Any) -> bool:
    """Return whether a rational function of sines and cosines is identically zero."""
    for angle in QUARTER:
        s, c = sin_cos(angle)
        expression = expression.xreplace({sp.sin(angle): s, sp.cos(angle): c})
    assert not expression.has(sp.sin, sp.cos, tilt, azimuth)
    numerator, _ = sp.fraction(sp.together(expression))
    # expanded as a polynomial: several times faster than as an expression
    return not sp.ring(sorted(numerator.free_symbols, key=str) or [time], sp.QQ)[0].from_expr(numerator)


def is_nonzero_somewhere(expression: Any) -> bool:
    """Return whether a rational function differs from zero at one point, in exact arithmetic."""
    for angle in QUARTER:
        s, c = sin_cos(angle)
        expression = expression.xreplace({sp.sin(angle): s, sp.cos(angle): c})
    symbols = sorted(expression.free_symbols, key=str)
    point = {symbol: sp.Rational(sp.prime(10 + k), sp.prime(40 + k)) for k, symbol in enumerate(symbols)}
    return bool(expression.xreplace(point) != 0)


def constants(transverse: Any = None, axial: Any = None, share: Any = 0) -> Body:
    """Return the constants of the code for a cylinder or frame of symbols."""
    cylinder = types.SimpleNamespace(
        base_radius=b,
        mass_centre_height=h,
        half_height=h,
        semidiagonal=R,
        tan_alpha=b / h,
        transverse_inertia=transverse,
        axial_inertia=axial,
        slab_mass_ratio=share,
    )
    body: Body = on_symbols(body_module.body_of)(cylinder, g)
    return body


def recess_residuals(body: Body, motion: tuple[Any, Any]) -> list[Any]:
    """Residuals of Lagrange's equations for the accelerations that the code returns."""
    _, tilt_acceleration, phi_rate, L_rate = on_symbols(equations.recess_rhs)(body, *STATE)
    inertia = L / phi_rate
    # L = B phi' and its rate; with x = tan(theta/4), dx = (1 + x^2)/4 dtheta
    x = QUARTER[tilt]
    inertia_rate = inertia.diff(x) * (1 + x**2) / 4 * omega
    phi_acceleration = (L_rate - inertia_rate * rate) / inertia
    accelerations = {theta_2: tilt_acceleration.subs(L, inertia * rate), phi_2: phi_acceleration}
    return [equation.xreplace(accelerations) for equation in motion]


@pytest.mark.slow
@pytest.mark.parametrize("share", [0], indirect=True, ids=["cylinder"])
def test_equations_18_and_19_follow_from_the_energies(motion: tuple[Any, Any]) -> None:
    s, c = sp.sin(tilt), sp.cos(tilt)
    a_r = a_x * sp.cos(azimuth) + a_y * sp.sin(azimuth)
    a_t = a_y * sp.cos(azimuth) - a_x * sp.sin(azimuth)
    # term by term as printed, with g + a_z for g
    equation_18 = (
        (I1 + h**2 + b**2) * theta_2
        + (b * c - h * s) * (g + a_z)
        + ((I2 - I1 + b**2 - h**2) * c * s - (I2 + b**2) * s - h * b * (1 + c) + 2 * h * b * c**2) * rate**2
        + (h * c + b * s) * a_r
    )
    equation_19 = (
        ((I1 - I2 + h**2 - b**2) * s**2 + 2 * (I2 + b**2) * (1 - c) + 2 * h * b * s * (1 - c)) * phi_2
        + 2 * (I2 - I1 - h**2 + b**2) * s * (1 - c) * rate * omega
        + (2 * h * b * (2 * s**2 + c - 1) + 2 * (I1 + h**2) * s) * rate * omega
        + (b * (1 - c) + h * s) * a_t
    )
    assert vanishes(motion[0] - equation_18)
    assert vanishes(motion[1] - equation_19)


@pytest.mark.slow
def test_recess_equations_are_lagranges(motion: tuple[Any, Any], share: Any) -> None:
    body = constants(I1, I2, share)
    assert on_symbols(equations.recess_rhs)(body, *STATE)[0] == omega
    for residual in recess_residuals(body, motion):
        assert vanishes(residual)


@pytest.mark.slow
@pytest.mark.parametrize("factor", [sp.Rational(101, 100), -1])
@pytest.mark.parametrize("name", ["b", "h", "A", "J", "C", "E", "p2", "sin_alpha", "cos_alpha"])
def test_a_wrong_coefficient_is_detected(name: str, factor: Any, motion: tuple[Any, Any], share: Any) -> None:
    body = constants(I1, I2, share)
    changed = body._replace(**{name: factor * getattr(body, name)})
    assert any(is_nonzero_somewhere(residual) for residual in recess_residuals(changed, motion))


@pytest.mark.parametrize("direction", [1, -1])
def test_planar_equation_is_lagranges(motion: tuple[Any, Any], share: Any, direction: int) -> None:
    acceleration = on_symbols(equations.planar_rhs)(constants(I1, I2, share), tilt, direction, a_x, a_z)
    planar = motion[0].subs({rate: 0, a_y: 0, azimuth: 0 if direction == 1 else sp.pi})
    assert vanishes(planar.subs(theta_2, acceleration))


@pytest.mark.slow
def test_energy_is_that_of_the_paper(paper: tuple[Any, Any], share: Any) -> None:
    kinetic, potential = (plain(part) for part in paper)
    body = constants(I1, I2, share)
    phi_rate = on_symbols(equations.recess_rhs)(body, *STATE)[2]
    total = on_symbols(equations.energy)(body, tilt, omega, L, 0.0)
    assert vanishes(
        (kinetic + potential - potential.subs(tilt, 0)).subs(rate, phi_rate) - (1 + 2 * share) * total
    )


def test_constants_of_a_homogeneous_cylinder() -> None:
    body = constants()
    alpha = sp.atan(b / h)
    expected = {
        "I1": (3 * b**2 + 4 * h**2) / 12,  # (16)
        "I2": b**2 / 2,  # (16)
        "p2": 12 * g / ((15 + sp.cos(alpha) ** 2) * R),  # (23)
        "sin_alpha": sp.sin(alpha),
        "cos_alpha": sp.cos(alpha),
        "alpha": alpha,
        "g": g,
    }
    for name, value in expected.items():
        difference = getattr(body, name) - value
        assert sp.simplify(difference.subs(R, sp.sqrt(b**2 + h**2))) == 0, name  # (20)
