"""Faults generated from the sources, one at a time in a copy of the checkout: the score of check and tests.

    python tests/mutation generated --count 60 --seed 1
    python tests/mutation generated --count 10 --only reduced/integration/uplift.py

A fault changes an operator, a comparison, a number, a condition, a sign or the order of two arguments.
Conditions under which bad input is refused, messages and annotations are left out. The test files
that import the changed module are asked first, then `rockwobble check`; a crash and a run out of time count
as found. Rows are kept in a table: a later call with the same sources goes on where the last one ended.
"""

from __future__ import annotations

import ast
import csv
import hashlib
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Iterator
from dataclasses import asdict, dataclass, fields
from pathlib import Path

PACKAGES = ("models", "reduced", "multibody", "compare", "studies")
_LEFT_OUT = shutil.ignore_patterns(".git", "__pycache__", ".mypy_cache", ".ruff_cache", "published", "docs")
_LIMIT = 600.0  # [s] many times what the check takes
_LONGEST = 900.0  # [s] time limit, many times that of a module's fast tests
_MOST = 6  # test files that are asked
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
    """One fault: index of a changeable node of its file."""

    file: str  # path in the checkout
    place: int
    change: str  # line, kind, and what is changed
    sources: str  # hash of the file


@dataclass(frozen=True, slots=True, kw_only=True)
class Row:
    """One table row: a fault and its detection by "check", "tests" or "nothing"."""

    file: str
    change: str
    sources: str
    found_by: str
    detail: str


def faults_of(file: str, source: str) -> list[GeneratedFault]:
    """Faults of a file."""
    digest = hashlib.sha256(source.encode()).hexdigest()[:12]
    tree = ast.parse(source)
    faults = []
    for place, (kind, node) in enumerate(_sites(tree)):
        line = getattr(node, "lineno", 0)
        words = f"line {line}, {kind}: {' '.join(ast.unparse(node).split())[:60]}"
        faults.append(GeneratedFault(file=file, place=place, change=words, sources=digest))
    return faults


def applied(fault: GeneratedFault, source: str) -> str:
    """Source with the fault applied."""
    tree = ast.parse(source)
    kind, node = list(_sites(tree))[fault.place]
    _change(kind, node)
    return ast.unparse(ast.fix_missing_locations(tree))


def _sites(tree: ast.AST) -> Iterator[tuple[str, ast.AST]]:
    """Yield kind and node of every changeable place."""
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
    """Sample of `count` faults, files in turn and in random order, so that each counts alike."""
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


def near(root: Path, file: str) -> list[str]:
    """Test files that import a module, with those of its package and name first.

    Where none does, those of the package.
    """
    package, name = (
        file.split("/")[0],
        Path(file).parent.name if file.endswith("__init__.py") else Path(file).stem,
    )
    imported = re.compile(rf"^(from|import) .*\b{name}\b", re.MULTILINE)
    files = sorted((root / "tests").rglob("test_*.py"))
    asked = [each for each in files if imported.search(each.read_text(encoding="utf-8")) or name in each.name]
    asked = asked or [each for each in files if each.parent.name == package]
    order = sorted(asked, key=lambda each: (each.parent.name != package, name not in each.name))
    return [each.relative_to(root).as_posix() for each in order[:_MOST]]


def tried(root: Path, fault: GeneratedFault) -> Row:
    """Apply a fault to a copy of the checkout, run tests and check, and revert it."""
    path = root / fault.file
    source = path.read_text(encoding="utf-8")
    path.write_text(applied(fault, source), encoding="utf-8")
    compiled, aside = root / "reduced/__pycache__", root.parent / "compiled"
    if compiled.is_dir():  # what is compiled from other sources is removed
        shutil.copytree(compiled, aside)
    found_by, detail = "nothing", ""
    try:
        options = ["-x", "-q", "-n0", "-m", "not slow", "-p", "no:cacheprovider"]
        for name, command, limit in (
            ("tests", ["-m", "pytest", *options, *near(root, fault.file)], _LONGEST),
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
    """Whether a command failed, and its last line."""
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


def run(checkout: Path, table: Path, *, count: int, seed: int, only: str) -> int:
    """Try a sample, write the table, print the score, and return the exit code.

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
        failed, words = _run(root, ["-c", _CHECK], limit=_LIMIT)
        if failed:
            raise ValueError(f"check must pass without a fault, got {words}")
        for fault in sample(checkout, count, seed, only):
            known = kept.get((fault.file, fault.change, fault.sources))
            rows.append(known or tried(root, fault))
            kept[fault.file, fault.change, fault.sources] = rows[-1]
            _write(table, list(kept.values()))
            print(f"{rows[-1].found_by}: {fault.file}, {fault.change}", flush=True)
    for package in PACKAGES:
        counts = Counter(row.found_by for row in rows if row.file.startswith(f"{package}/"))
        shares = (f"{counts[name]} by {name}" for name in ("check", "tests", "nothing"))
        print(f"{package}: {', '.join(shares)}")
    score = sum(row.found_by != "nothing" for row in rows)
    print(f"{score} of {len(rows)} faults found")
    return 0


def _write(table: Path, rows: list[Row]) -> None:
    with table.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, [each.name for each in fields(Row)], lineterminator="\n")
        writer.writeheader()
        writer.writerows(asdict(row) for row in rows)
