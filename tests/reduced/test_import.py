from __future__ import annotations

import subprocess
import sys


def test_scipy_is_loaded_by_what_uses_it():
    # every worker process imports this package, and few ask for an exact solution: 0.7 s of 1.6 s
    script = "import sys, rockwobble.reduced; print(*{'scipy.optimize', 'scipy.special'} & set(sys.modules))"
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert found.stdout == "\n"
