from __future__ import annotations

import os
import pickle
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from rockwobble import reduced
from rockwobble.models import Case, Cylinder, InitialState, bounds, el_centro_1940
from rockwobble.reduced import _compile
from rockwobble.reduced._compile import _is_ours
from rockwobble.reduced.integration import result

pytestmark = pytest.mark.slow

PIER = Cylinder(semidiagonal=6.0, tan_alpha=0.2)


def test_scipy_is_not_loaded_with_the_package():
    # every worker process imports this package, and few ask for an exact solution: 0.7 s of 1.6 s
    script = "import sys, rockwobble.reduced; print(*{'scipy.optimize', 'scipy.special'} & set(sys.modules))"
    process = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert process.stdout == "\n"


# as in an installation of another user with a HOME that cannot be written
NOWHERE = """
from numba.core.caching import CompileResultCacheImpl as kind
kind._locator_classes = [each for each in kind._locator_classes if "UserProvided" in each.__name__]
import os, rockwobble.reduced
print(os.environ["NUMBA_CACHE_DIR"])
"""


def test_compiled_code_falls_back_to_a_private_folder(tmp_path):
    environment = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
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
    # a fixed name, so the same folder as long as only this user can write to it
    assert folder == tmp_path / f"rockwobble-compiled-{os.getuid()}"
    assert _is_ours(folder)
    folder.chmod(0o777)  # other users may have put code there
    other, _ = start()
    assert (other.parent, other != folder) == (tmp_path, True)


@pytest.mark.parametrize(
    ("mode", "ours"), [(0o700, True), (0o755, True), (0o711, True), (0o720, False), (0o702, False)]
)
def test_a_private_folder_is_writable_by_its_owner_alone(tmp_path, mode, ours):
    tmp_path.chmod(mode)
    assert _is_ours(tmp_path) == ours


def test_compiled_code_imports_constants_from_its_own_folder():
    folder = Path(_compile.__file__).parent
    files = [folder / name for name in ("body.py", "equations.py", "restoring.py", "rolling.py")]
    files += sorted((folder / "integration").glob("*.py"))
    for file in files:
        for names in re.findall(
            r"^from rockwobble\S* import (.*)", file.read_text(encoding="utf-8"), re.MULTILINE
        ):
            assert {*names.split(", ")} <= {"RockingBody", "Tendon", "require_positive"}, (
                file
            )  # kernels take checked numbers: no check is compiled
    assert result.OVERTURNED_TILT == bounds.OVERTURNED_TILT


# a package of one kernel, in which the file imported last holds a coefficient
SOURCES = {
    "__init__.py": "",
    "entry.py": "from ._compile import kernel\nfrom .inner.scaling import scaled\n\n\n"
    "@kernel\ndef value(x):\n    return scaled(x)\n",
    "inner/__init__.py": "",
    "inner/scaling.py": "from .._compile import jit\nfrom ..table import FACTOR\n\n\n"
    "@jit\ndef scaled(x):\n    return FACTOR * x\n",
    "table.py": "FACTOR = 2.0\n",
}
CALL = "from made import entry, _compile as c; print(c.on_disk(entry.value), entry.value(5.0), end='')"
OLD = 1_000_000_000.0  # a time of a file in 2001 [s]


@pytest.fixture
def made(tmp_path: Path) -> Path:
    folder = tmp_path / "made"
    for name, text in SOURCES.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(text)
    shutil.copy(_compile.__file__, folder / "_compile.py")
    return folder


def called(folder: Path) -> str:
    command = [sys.executable, "-c", CALL]
    environment = {name: value for name, value in os.environ.items() if not name.startswith("NUMBA_")}
    done = subprocess.run(
        command, cwd=folder.parent, env=environment, capture_output=True, text=True, check=True
    )
    return done.stdout


def test_compiled_code_is_cached_by_the_content_of_its_sources(made: Path) -> None:
    assert [called(made), called(made)] == ["False 10.0", "True 10.0"]
    (made / "table.py").write_text("FACTOR = 3.0\n")
    os.utime(made / "table.py", (OLD, OLD))
    assert called(made) == "False 15.0"
    (kept,) = (made / "__pycache__").glob("*.nbi")  # the code of the other source is gone
    for path in made.rglob("*.py"):
        os.utime(path)
    assert called(made) == "True 15.0"
    assert kept.exists()


@pytest.mark.parametrize("options", [{"support": "recess"}, {"support": "flat"}, {"plane": 0.0}])
def test_a_column_of_times_needs_no_new_compilation(options):
    case = Case(PIER, el_centro_1940().scaled(2.0), duration=3.0)
    problem = reduced.simulate(case, **options).source.problem
    column = np.linspace(0.0, 3.0, 20).reshape(10, 2)[:, 0]
    before = list(problem._set_up.integrate.signatures)  # of bodies with a tendon, too, where one has run
    result, _ = problem.solve(column)
    assert result.samples.tolist() == problem.solve(column.copy())[0].samples.tolist()
    # a strided array would take ten seconds of compilation
    assert problem._set_up.integrate.signatures == before


def test_a_pickled_response_is_the_same_and_compiles_nothing():
    # compiled code in a pickled response would be compiled again in the other process, for many seconds
    response = reduced.simulate(Case(PIER, initial=InitialState(0.1, rolling_rate=0.1), duration=1.0))
    sent = pickle.loads(pickle.dumps(response))
    there, here = (each.source.problem for each in (sent, response))
    assert there.solve(np.empty(0))[0].peak == here.solve(np.empty(0))[0].peak
    assert there._set_up.integrate is here._set_up.integrate
    np.testing.assert_array_equal(sent.centre_of_mass, response.centre_of_mass)
    assert sent.contact_point.shape == (len(sent.time), 2)
    assert sent.passes.equals(response.passes)
    assert sent.peak_displacement == response.peak_displacement == np.hypot(*response.displacement.T).max()
