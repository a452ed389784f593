"""What is installed: the folders under their names, their data, the command, and nothing heavy at import."""

from __future__ import annotations

import ast
import importlib
import pkgutil
import subprocess
import sys
from importlib.metadata import entry_points, version
from importlib.resources import files
from pathlib import Path

import pytest

import rockwobble
from rockwobble.multibody.engines.registry import engine_packages

CHECKOUT = Path(__file__).parents[1]
FOLDERS = ["models", "reduced", "multibody", "compare", "studies", "reports"]
ENGINES = [*engine_packages().values(), "pydrake"]  # the name by which Drake is imported
HEAVY = [*ENGINES, "pandas", "pyarrow", "matplotlib", "jinja2", "scipy", "sympy"]


def run(*command: str) -> str:
    return subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout


def test_wheel_has_the_folders_command_and_py_typed() -> None:
    assert all((files(f"rockwobble.{folder}") / "__init__.py").is_file() for folder in FOLDERS)
    inside = {path.name for place in rockwobble.__path__ for path in Path(place).iterdir()}
    assert inside - {"__pycache__"} == {*FOLDERS, "__init__.py", "__init__.pyi", "__main__.py", "py.typed"}


def test_a_type_checker_resolves_each_public_name() -> None:
    stub = ast.parse(Path(str(rockwobble.__file__)).with_suffix(".pyi").read_text(encoding="utf-8")).body
    told = {alias.name for node in stub if isinstance(node, ast.ImportFrom) for alias in node.names}
    assert set(rockwobble.__all__) == told >= {"compare", "comparison"}


@pytest.mark.parametrize("folder", ["models", "compare", "reports"])
def test_every_data_file_of_the_checkout_is_installed(folder: str) -> None:
    installed = files(f"rockwobble.{folder}")
    data = [
        path.relative_to(CHECKOUT / folder)
        for path in (CHECKOUT / folder).rglob("*")
        if path.is_file()
        and path.suffix not in (".py", ".pyc", ".nbi", ".nbc")
        and "published" not in path.relative_to(CHECKOUT).parts
    ]
    assert data
    missing = [str(path) for path in data if not installed.joinpath(*path.parts).is_file()]
    assert missing == []


def test_no_name_of_a_package_hides_its_module() -> None:
    names = [module.name for module in pkgutil.walk_packages(rockwobble.__path__, "rockwobble.")]
    modules = {name: importlib.import_module(name) for name in names}
    assert len(modules) > 200
    hidden = [
        name
        for name, module in modules.items()
        if "." in name.removeprefix("rockwobble.")
        and getattr(modules[name.rpartition(".")[0]], name.rpartition(".")[2]) is not module
    ]
    assert hidden == []
    for name, module in modules.items():
        folder, _, own = name.rpartition(".")
        beside = {other.rpartition(".")[2] for other in modules if other.rpartition(".")[0] == folder} - {own}
        made = {key for key, each in vars(module).items() if getattr(each, "__module__", "") == name}
        assert not made & beside, name


@pytest.mark.slow
def test_no_module_binds_a_name_twice() -> None:
    # a second table of one name replaces the first without a word
    twice = []
    for path in (path for folder in FOLDERS for path in (CHECKOUT / folder).rglob("*.py")):
        names: set[str] = set()
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            targets = node.targets if isinstance(node, ast.Assign) else [node]
            for each in (part for target in targets for part in _bound(target)):
                if each in names:
                    twice.append(f"{path.relative_to(CHECKOUT)}: {each}")
                names.add(each)
    assert twice == []


def _bound(node: ast.AST) -> list[str]:
    """Names that an assignment, a function or a class binds in its module."""
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        overload = any(ast.unparse(each).split(".")[-1] == "overload" for each in node.decorator_list)
        return [] if overload else [node.name]
    if isinstance(node, ast.AnnAssign):
        node = node.target
    if isinstance(node, ast.Name | ast.Tuple | ast.List):
        return [part.id for part in ast.walk(node) if isinstance(part, ast.Name)]
    return []


def test_the_records_are_data_of_the_package() -> None:
    names = {entry.name for entry in (files("rockwobble.models") / "records").iterdir()}
    assert {name[-8:] for name in names if name.endswith(".AT2")} == {"hor1.AT2", "hor2.AT2", "C-UP.AT2"}
    assert "README.md" in names


def test_the_command_is_installed_and_knows_its_version() -> None:
    (command,) = entry_points(group="console_scripts", name="rockwobble")
    assert command.value == "rockwobble.__main__:main"
    script = Path(sys.executable).with_name("rockwobble")
    assert run(str(script), "--version").strip() == f"rockwobble {version('rockwobble')}"


@pytest.mark.slow
@pytest.mark.parametrize(
    "load",
    [
        *(f"import rockwobble.{module}" for module in ("models", "multibody", "compare", "reports.cli.main")),
        *(f"rockwobble.{name}" for name in ("comparison", "simulate", "read_record", "GroundMotion")),
    ],
)
def test_importing_loads_no_engine_no_tables_and_no_scipy(load: str) -> None:
    script = f"import sys, rockwobble; {load}; print(*sorted({ {*HEAVY}!r} & set(sys.modules)))"
    assert run(sys.executable, "-c", script).split() == []


def test_a_run_of_an_engine_is_sent_without_pandas() -> None:
    script = """
import pickle, sys
import rockwobble as rw
pier = rw.Cylinder(semidiagonal=6.0, tan_alpha=0.2)
case = rw.Case(pier, initial=rw.InitialState(0.5 * pier.alpha, rolling_rate=0.5), duration=1.0)
sent = pickle.dumps(rw.simulate(case, engine="mujoco"))
print("pandas" in sys.modules, len(pickle.loads(sent).passes), "pandas" in sys.modules)
"""
    assert run(sys.executable, "-c", script).split() == ["False", "0", "True"]


def test_threads_that_ask_for_the_first_table_at_once_all_get_it() -> None:
    script = """
from concurrent.futures import ThreadPoolExecutor
from rockwobble.models.frames import pd
with ThreadPoolExecutor(8) as pool:
    print({*pool.map(lambda _: pd.DataFrame.__name__, range(8))})
"""
    assert run(sys.executable, "-c", script).strip() == "{'DataFrame'}"


@pytest.mark.slow
def test_a_run_needs_neither_scipy_stats_nor_matplotlib(tmp_path: Path) -> None:
    script = f"""
import sys
from rockwobble.reports.cli.main import main
try:
    main(["simulate", "--release-tilt-deg", "5", "--duration", "1", "--out", {str(tmp_path / "run")!r}])
except SystemExit:
    print({{"scipy.stats", "scipy.optimize", "matplotlib"}} & set(sys.modules) or "light")
"""
    assert run(sys.executable, "-c", script).splitlines()[-1] == "light"
