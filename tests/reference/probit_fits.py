"""Fragility curves of random counts by statsmodels, from a version that is kept: the table probit_fits.csv.

``python tests/reference/probit_fits.py > tests/reference/probit_fits.csv`` writes
it anew; made with statsmodels 0.15.0.
"""

from __future__ import annotations

from itertools import count
from math import erf, sqrt

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
SETS = 100


def data_set(seed: int) -> tuple[Array, Array, Array]:
    """Logarithms of intensities, runs and exceedances of one random set of stripes (K,)."""
    random = np.random.default_rng(seed)
    levels = int(random.integers(4, 21))
    x = np.sort(random.uniform(-1.0, 2.0, levels))
    n = random.integers(5, 45, levels)
    centre, dispersion = random.uniform(-0.2, 1.2), random.uniform(0.2, 1.0)
    share = [0.5 * (1.0 + erf(z / sqrt(2.0))) for z in (x - centre) / dispersion]
    return x, n.astype(float), random.binomial(n, share).astype(float)


def main() -> None:
    import statsmodels.api as sm

    print("# Lognormal fragility curves by maximum likelihood: seed of data_set, ln median, dispersion")
    print("seed,centre,dispersion")
    done = 0
    for seed in count():
        x, n, k = data_set(seed)
        if not (k > 0.0).any() or x[k < n].max(initial=-9.0) <= x[k > 0.0].min():
            continue  # separated: there is no maximum
        family = sm.families.Binomial(link=sm.families.links.Probit())
        model = sm.GLM(np.column_stack([k, n - k]), sm.add_constant(x), family=family)
        a, b = model.fit(method="newton", tol=1e-14, maxiter=500).params
        print(f"{seed},{-a / b:.12g},{1.0 / b:.12g}")
        done += 1
        if done == SETS:
            break


if __name__ == "__main__":
    main()
