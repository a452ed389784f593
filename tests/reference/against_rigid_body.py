"""Print on how many of 200 random problems the reduced models differ from an integration of the rigid body.

All kinds of `shaken_problems`, a fifth of them releases, at two tolerances. A problem counts where perturbed
copies (1e-9 and, for the default tolerance, 1e-7 of the record) give it alike:
``python tests/reference/against_rigid_body.py [first] [last]``.
"""

from __future__ import annotations

import sys

from rigid_body import integrate
from shaken_problems import Problem, problem


def perturbed(given: Problem, share: float) -> Problem:
    return given._replace(motion=given.motion.scaled(1.0 + share))


def main() -> None:
    first, last = (int(word) for word in sys.argv[1:3]) if len(sys.argv) > 2 else (0, 200)
    for rtol, share, bound in ((1e-11, 1e-9, 1e-6), (1e-8, 1e-7, 1e-5)):
        firm, off = 0, 0
        for seed in range(first, last):
            given = problem(seed, models=("recess", "flat"), released=seed % 5 == 0)
            exact, copy = integrate(given), integrate(perturbed(given, share))
            alpha = given.cylinder.alpha
            if exact.outcome != copy.outcome or not abs(exact.peak - copy.peak) <= bound * alpha:
                continue
            firm += 1
            found = given.simulate(rtol=rtol)
            if found.outcome != exact.outcome or not abs(found.peak_tilt - exact.peak) <= bound * alpha:
                off += 1
                print(f"{seed}: {exact}, {found.outcome} {found.peak_tilt!r} at {rtol:g}, {given.cylinder}")
        print(
            f"rtol {rtol:g}: {off} of {firm} not sensitive differ by more than {bound:g} alpha or in outcome"
        )


if __name__ == "__main__":
    main()
