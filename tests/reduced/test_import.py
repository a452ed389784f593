from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, el_centro_1940
from rockwobble.reduced._compile import _is_ours, on_disk


def test_scipy_is_loaded_by_what_uses_it():
    # every worker process imports this package, and few ask for an exact solution: 0.7 s of 1.6 s
    script = "import sys, rockwobble.reduced; print(*{'scipy.optimize', 'scipy.special'} & set(sys.modules))"
    found = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert found.stdout == "\n"


# as where the installation belongs to somebody else and HOME cannot be written
NOWHERE = """
from numba.core.caching import CompileResultCacheImpl as kind
kind._locator_classes = [each for each in kind._locator_classes if "UserProvided" in each.__name__]
import os, rockwobble.reduced
print(os.environ["NUMBA_CACHE_DIR"])
"""


def test_compiled_code_goes_to_a_folder_of_ours_where_it_has_no_other_place(tmp_path):
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment["TMPDIR"] = str(tmp_path)

    def start() -> tuple[Path, str]:
        done = subprocess.run(
            [sys.executable, "-c", NOWHERE], env=environment, capture_output=True, text=True, check=True
        )
        return Path(done.stdout.strip()), done.stderr

    folder, said = start()
    assert said == (
        f"rockwobble: neither the installation nor HOME can be written: compiled code is kept in {folder}\n"
    )
    # the same name each time, and so the same folder for as long as it is ours
    assert folder == tmp_path / f"rockwobble-compiled-{os.getuid()}"
    assert _is_ours(folder)
    folder.chmod(0o777)  # anybody may have put code there
    other, _ = start()
    assert (other.parent, other != folder) == (tmp_path, True)


def test_stale_code_that_another_process_has_removed_meanwhile_is_no_error(monkeypatch, tmp_path):
    kept = tmp_path / "driver.integrate_recess-1.py311.nbi"
    true = Path.glob  # that of the sources goes on

    def glob(self, pattern, **options):
        return [kept] if pattern == "*.nbi" else true(self, pattern, **options)

    monkeypatch.setattr(Path, "glob", glob)
    entry = SimpleNamespace(stats=SimpleNamespace(cache_path=tmp_path), __name__="integrate_recess")
    assert not on_disk(entry)
    kept.touch()
    assert on_disk(entry)


@pytest.mark.parametrize("options", [{"support": "recess"}, {"support": "flat"}, {"plane": 0.0}])
def test_a_column_of_times_is_solved_by_what_is_compiled(options):
    case = Case(Cylinder(semidiagonal=6.0, tan_alpha=0.2), el_centro_1940().scaled(2.0), duration=3.0)
    problem = reduced.simulate(case, **options).source.problem
    column = np.linspace(0.0, 3.0, 20).reshape(10, 2)[:, 0]
    result, _ = problem.solve(column)
    assert result.samples.tolist() == problem.solve(column.copy())[0].samples.tolist()
    # for strided arrays it would be compiled anew, for ten seconds
    assert len(problem._set_up.integrate.signatures) == 1
