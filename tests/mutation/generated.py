"""Faults generated from the sources, one at a time in a copy of the checkout: the score of check and tests.

    python tests/mutation generated --count 60 --seed 1
    python tests/mutation generated --count 10 --only reduced/integration/uplift.py

A fault changes an operator, a comparison, a number, a condition, a sign or the order of two arguments.
Conditions under which bad input is refused, messages and annotations are left out. The tests
that call the changed function are asked first, then `rockwobble check`; a crash and a run out of time count
as found. Rows are kept in a table: a later call with the same sources goes on where the last one ended.
"""

from __future__ import annotations

import ast
import csv
import hashlib
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path

from .reach import PACKAGES, Reach, near, read

_LEFT_OUT = shutil.ignore_patterns(".git", "__pycache__", ".mypy_cache", ".ruff_cache", "published", "docs")
_LIMIT = 600.0  # [s] many times what the check takes
_RECORDING = 7200.0  # [s] many times what the tests take one after another, each call recorded
_SLOWER, _START = 10.0, 120.0  # times the recorded time of tests, and seconds beside it: of a busy machine
# [s] of tests that are asked: what calls a function and does not see its fault in so long seldom does later
_LONGEST = 60.0
_OPERATORS: dict[type[ast.operator], ast.operator] = {
    ast.Add: ast.Sub(),
    ast.Sub: ast.Add(),
    ast.Mult: ast.Div(),
    ast.Div: ast.Mult(),
    ast.Pow: ast.Mult(),
}
_COMPARISONS: dict[type[ast.cmpop], ast.cmpop] = {
    ast.Lt: ast.LtE(),
    ast.LtE: ast.Lt(),
    ast.Gt: ast.GtE(),
    ast.GtE: ast.Gt(),
    ast.Eq: ast.NotEq(),
    ast.NotEq: ast.Eq(),
}
_CHECK = """
import sys
from rockwobble.compare.check import check
found = check()
print(found)
sys.exit(not found.passed)
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class GeneratedFault:
    """One fault: the place of a node among those of its file that can be changed.

    Parameters
    ----------
    file : str
        Path in the checkout.
    place : int
    function : int, optional
        First line of the function that it is in.
    change : str
        Line, kind, and what is changed.
    sources : str
        Hash of the file.
    """

    file: str
    place: int
    function: int | None
    change: str
    sources: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One line of the table: a fault and what found it, "check", "tests" or "nothing"."""

    file: str
    change: str
    sources: str
    found_by: str
    detail: str


def faults_of(file: str, source: str) -> list[GeneratedFault]:
    """Return the faults of a file."""
    digest = hashlib.sha256(source.encode()).hexdigest()[:12]
    tree = ast.parse(source)
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    found = []
    for place, (kind, node) in enumerate(_sites(tree)):
        line = getattr(node, "lineno", 0)
        words = f"line {line}, {kind}: {' '.join(ast.unparse(node).split())[:60]}"
        function = _function_at(functions, line)
        found.append(GeneratedFault(file=file, place=place, function=function, change=words, sources=digest))
    return found


def applied(fault: GeneratedFault, source: str) -> str:
    """Return the source with the fault in it."""
    tree = ast.parse(source)
    kind, node = list(_sites(tree))[fault.place]
    _change(kind, node)
    return ast.unparse(ast.fix_missing_locations(tree))


def _function_at(functions: Sequence[ast.FunctionDef], line: int) -> int | None:
    """Return the first line of the innermost function with a line in its body, as its code object has it."""
    around = [node for node in functions if node.body[0].lineno <= line <= (node.end_lineno or 0)]
    if not around:
        return None
    innermost = max(around, key=lambda node: node.lineno)
    return min([innermost.lineno, *(each.lineno for each in innermost.decorator_list)])


def _sites(tree: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """Yield kind and node of everything that can be changed."""
    waiting: list[ast.AST] = [tree]
    while waiting:
        node = waiting.pop()
        refusal = isinstance(node, ast.If) and any(isinstance(each, ast.Raise) for each in node.body)
        if (
            isinstance(node, ast.Raise | ast.JoinedStr | ast.AnnAssign | ast.Import | ast.ImportFrom)
            or refusal
        ):
            continue
        kind = _kind(node)
        if kind:
            yield kind, node
        parts = [each for name, each in ast.iter_fields(node) if name not in ("annotation", "returns")]
        nested = [item for part in parts for item in (part if isinstance(part, list) else [part])]
        waiting += [item for item in reversed(nested) if isinstance(item, ast.AST)]


def _kind(node: ast.AST) -> str:
    if isinstance(node, ast.BinOp) and type(node.op) in _OPERATORS:
        return "operator"
    if isinstance(node, ast.Compare) and type(node.ops[0]) in _COMPARISONS:
        return "comparison"
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return "number"
    if isinstance(node, ast.If | ast.IfExp | ast.While):
        return "condition"
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return "sign"
    return "arguments" if isinstance(node, ast.Call) and len(node.args) > 1 else ""


def _change(kind: str, node: ast.AST) -> None:
    if isinstance(node, ast.BinOp):
        node.op = _OPERATORS[type(node.op)]
    elif isinstance(node, ast.Compare):
        node.ops[0] = _COMPARISONS[type(node.ops[0])]
    elif isinstance(node, ast.Constant) and isinstance(node.value, int | float):
        node.value = node.value + 1 if isinstance(node.value, int) or node.value == 0.0 else 1.01 * node.value
    elif isinstance(node, ast.If | ast.IfExp | ast.While):
        node.test = ast.UnaryOp(op=ast.Not(), operand=node.test)
    elif isinstance(node, ast.UnaryOp):
        node.op = ast.UAdd()
    elif isinstance(node, ast.Call):
        node.args[0], node.args[1] = node.args[1], node.args[0]


def sample(checkout: Path, count: int, seed: int, only: str = "") -> list[GeneratedFault]:
    """Return `count` faults: files in turn and in a random order, so that each counts alike."""
    chance, by_file = random.Random(seed), []
    for package in PACKAGES:
        for path in sorted((checkout / package).rglob("*.py")):
            name = path.relative_to(checkout).as_posix()
            faults = faults_of(name, path.read_text(encoding="utf-8")) if only in name else []
            chance.shuffle(faults)
            by_file += [faults] if faults else []
    chance.shuffle(by_file)
    turns = [
        of[turn] for turn in range(max(map(len, by_file), default=0)) for of in by_file if turn < len(of)
    ]
    return turns[:count]


def tried(root: Path, fault: GeneratedFault, tests: Sequence[Reach]) -> Row:
    """Put a fault into a copy of the checkout, ask tests and check, and take it out again."""
    path = root / fault.file
    source = path.read_text(encoding="utf-8")
    path.write_text(applied(fault, source), encoding="utf-8")
    compiled, aside = root / "reduced/__pycache__", root.parent / "compiled"
    if compiled.is_dir():  # what is compiled from other sources is removed
        shutil.copytree(compiled, aside)
    found_by, detail = "nothing", ""
    try:
        asked: list[str] = []
        seconds = 0.0
        for test in near(tests, fault.file, fault.function):
            if asked and seconds + test.seconds > _LONGEST:
                break
            asked.append(test.test)
            seconds += test.seconds
        named = root.parent / "asked.txt"
        named.write_text("\n".join(asked), encoding="utf-8")
        of_tests = ["-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", f"@{named}"]
        for name, command, limit in (
            ("tests", of_tests, _START + _SLOWER * seconds),
            ("check", ["-c", _CHECK], _LIMIT),
        ):
            failed, words = _run(root, command, limit=limit)
            if failed:
                found_by, detail = name, words
                break
    finally:
        path.write_text(source, encoding="utf-8")
        if aside.is_dir():
            shutil.rmtree(compiled)
            aside.rename(compiled)
    return Row(file=fault.file, change=fault.change, sources=fault.sources, found_by=found_by, detail=detail)


def _run(root: Path, command: list[str], *, limit: float) -> tuple[bool, str]:
    """Return whether a command failed, and its last line."""
    environment = os.environ | {
        "PYTHONPATH": f"{root / 'src'}{os.pathsep}{root / 'tests'}",
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    try:
        shown = subprocess.run(
            [sys.executable, "-P", *command],
            cwd=root,
            env=environment,
            capture_output=True,
            text=True,
            check=False,
            timeout=limit,
        )
    except subprocess.TimeoutExpired:
        return True, "out of time"
    lines = [line for line in (shown.stdout + shown.stderr).splitlines() if line.strip()]
    return shown.returncode != 0, " ".join(lines[-1:])[:200]


def recorded(root: Path, reach: Path) -> list[Reach]:
    """Return what each test calls: as it was recorded, or else by a run of the tests in the copy.

    Raises
    ------
    ValueError
        If check fails in the copy without a fault.
    """
    if not reach.is_file():
        tests = [f"tests/{package}" for package in PACKAGES]
        record = ["-m", "pytest", "-q", "-n2", "-p", "no:cacheprovider", "-p", "mutation.reach", *tests]
        os.environ["REACH"] = str(reach.resolve())
        print("recording once what each test calls, some half an hour; kept in", reach, flush=True)
        failed, words = _run(root, ["-c", _CHECK], limit=_LIMIT)
        if failed:
            raise ValueError(f"check must pass without a fault, got {words}")
        print("tests:", _run(root, record, limit=_RECORDING)[1], flush=True)
    return read(reach)


def run(checkout: Path, table: Path, *, count: int, seed: int, only: str, reach: Path) -> int:
    """Try a sample, keep the table, print the score, and return the exit code.

    Raises
    ------
    ValueError
        If check fails in the copy without a fault.
    """
    kept = {}
    if table.is_file():
        with table.open(encoding="utf-8", newline="") as file:
            kept = {(row["file"], row["change"], row["sources"]): Row(**row) for row in csv.DictReader(file)}
    rows: list[Row] = []
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        root = Path(folder) / "copy"
        shutil.copytree(checkout, root, symlinks=True, ignore=_LEFT_OUT)
        tests = recorded(root, reach)
        for fault in sample(checkout, count, seed, only):
            known = kept.get((fault.file, fault.change, fault.sources))
            rows.append(known or tried(root, fault, tests))
            kept[fault.file, fault.change, fault.sources] = rows[-1]
            _write(table, list(kept.values()))
            print(f"{rows[-1].found_by}: {fault.file}, {fault.change}", flush=True)
    for package in PACKAGES:
        counts = Counter(row.found_by for row in rows if row.file.startswith(f"{package}/"))
        shares = (f"{counts[name]} by {name}" for name in ("check", "tests", "nothing"))
        print(f"{package}: {', '.join(shares)}")
    found = sum(row.found_by != "nothing" for row in rows)
    print(f"{found} of {len(rows)} faults found")
    return 0


def _write(table: Path, rows: list[Row]) -> None:
    with table.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, [each.name for each in fields(Row)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)
