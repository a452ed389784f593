"""Reference documentation of every public name, command and key; notebooks stored without output."""

from __future__ import annotations

import ast
import importlib
import inspect
import json
import re
import runpy
from fnmatch import filter as fnmatch_filter
from fnmatch import fnmatch
from pathlib import Path

import pytest
import typer

import rockwobble
from rockwobble import compare, reduced
from rockwobble.compare.storage.manifest import read_manifests
from rockwobble.models import Case, Cylinder, InitialState, Run
from rockwobble.models.finding import GRADES
from rockwobble.models.suites.tables import TABLES
from rockwobble.models.trace_file import COLUMNS, OF_FRAMES, OF_TENDONS, PASS_COLUMNS
from rockwobble.reports.cli.main import app
from rockwobble.reports.pages.wording import words
from rockwobble.reports.registry import COMMANDS, KINDS

pytestmark = pytest.mark.checkout

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
API = DOCS / "reference" / "api"
PACKAGES = ["models", "reduced", "multibody", "compare", "compare.check", "studies"]
PARTS = {"models", "reduced", "multibody", "compare", "studies", "reports"}
# full names of function and results, by the name at the top
STUDIES = runpy.run_path(str(DOCS / "_extensions" / "public_studies.py"))["public_studies"]()
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))


def documented() -> set[str]:
    """Full names that the pages of the reference document."""
    names = set()
    for page in API.glob("*.rst"):
        module = ""
        for line in page.read_text(encoding="utf-8").splitlines():
            if match := re.match(r"\.\. currentmodule:: (\S+)", line):
                module = match.group(1)
            elif match := re.match(r"\.\. auto(?:class|function|exception|data):: (\S+)", line):
                name = match.group(1)
                names.add(name if name.startswith("rockwobble.") else f"{module}.{name}")
            elif line == ".. rockwobble-studies::":
                names |= {name for both in STUDIES.values() for name in both}
    return names


@pytest.mark.parametrize("package", PACKAGES)
def test_every_public_name_is_documented(package: str) -> None:
    public = {
        f"rockwobble.{package}.{name}" for name in importlib.import_module(f"rockwobble.{package}").__all__
    }
    assert public
    assert public - documented() == set()


def public(package: str) -> dict[str, object]:
    """Public names of a package, in full."""
    module = importlib.import_module(f"rockwobble.{package}")
    return {f"{package}.{name}": inspect.unwrap(getattr(module, name)) for name in module.__all__}


@pytest.mark.parametrize("package", PACKAGES)
def test_public_functions_and_members_have_docstrings(package: str) -> None:
    silent = []
    for name, thing in public(package).items():
        if inspect.isfunction(thing):
            said, signature = inspect.getdoc(thing) or "", inspect.signature(thing)
            silent += [name] * bool(signature.parameters and "Parameters\n" not in said)
            silent += [name] * (signature.return_annotation not in ("None", None) and "Returns\n" not in said)
        for member, value in vars(thing).items() if inspect.isclass(thing) else ():
            asked = isinstance(value, property | classmethod | staticmethod) or inspect.isfunction(value)
            if asked and not member.startswith("_") and not (inspect.getdoc(getattr(thing, member)) or ""):
                silent.append(f"{name}.{member}")
    assert silent == []


def test_public_functions_have_examples() -> None:
    # tests/test_doctests.py runs them
    names = [(rockwobble, name) for name in rockwobble.__all__ if name not in PARTS]
    names += [(reduced, name) for name in reduced.__all__]
    called = {name: inspect.unwrap(getattr(place, name)) for place, name in names}
    silent = [name for name, each in called.items() if callable(each) and ">>>" not in (each.__doc__ or "")]
    # their records are in an extra, without which the examples have to run
    assert silent == ["far_field_motions", "p695_far_field"]


def test_reference_identifiers_are_well_formed_and_all_citations_resolve() -> None:
    page = (DOCS / "references.md").read_text(encoding="utf-8")
    links = re.findall(r"\[doi:(\S+?)\]\((\S+?)\)", page)
    assert len(links) >= 10
    assert [doi for doi, link in links if not re.fullmatch(r"10\.\d{4,5}/\S+", doi)] == []
    assert [doi for doi, link in links if link != f"https://doi.org/{doi}"] == []
    for cited in ("V17", "VB17", "H63", "SR08", "YCP80", "B18", "DATA"):
        assert f"\n[{cited}]\n" in page, cited


def test_documented_names_exist() -> None:
    names = [name.rpartition(".")[::2] for name in documented()]
    assert [each for each in names if not hasattr(importlib.import_module(each[0]), each[1])] == []


def test_top_level_names_are_on_the_first_reference_page() -> None:
    page = (API / "index.md").read_text(encoding="utf-8")
    lacking = {name for name in rockwobble.__all__ if f"`rw.{name}`" not in page}
    assert lacking - STUDIES.keys() == set()  # which the page of the studies lists by itself


def test_every_command_help_is_on_a_reference_page() -> None:
    pages = (DOCS / "reference" / "commands").glob("*.md")
    shown = "".join(page.read_text(encoding="utf-8") for page in pages)
    groups = " ".join(re.findall(r"\{rockwobble-commands\} (.+)", shown)).split()
    of_groups = {name for name, entry in COMMANDS.items() if entry.group in groups}
    commands = typer.main.get_command(app).commands  # type: ignore[attr-defined]
    alone = re.findall(r"\{rockwobble-command\} (\S+)", shown)
    assert sorted([*alone, *of_groups]) == sorted(commands)


def test_keys_of_suites_and_groups_of_findings_are_on_their_pages() -> None:
    page = (DOCS / "reference" / "suite-file.md").read_text(encoding="utf-8")
    keys = [key for name, table in TABLES.items() if name for key in table.model_fields]
    assert len(keys) > 40
    assert [key for key in keys if f"`{key}`" not in page] == []
    page = (DOCS / "reference" / "findings.md").read_text(encoding="utf-8")
    listed = [group for line in re.findall(r"\{findings-table\} (.*)", page) for group in line.split()]
    labels = {"word", "diagnostic", "figure", "number", "motions", "progress"}  # which nothing decides
    assert sorted(listed) == sorted({*words()} - labels)


def stated_levels() -> dict[str, set[str]]:
    """Levels of each key or key pattern on the page of findings, in its order."""
    page = (DOCS / "reference" / "findings.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| (`.*`) \| (.*) \|$", page.partition("## Levels")[2], re.MULTILINE)
    return {key: set(levels.split(", ")) for keys, levels in rows for key in re.findall(r"`(.*?)`", keys)}


def levels_of(key: str) -> set[str]:
    """Levels of a key on the page."""
    stated = stated_levels()
    return next((stated[each] for each in stated if fnmatch(key, each)), {"note"})


def constants(node: ast.AST) -> set[str]:
    """String constants of an expression."""
    values = (each.value for each in ast.walk(node) if isinstance(each, ast.Constant))
    return {value for value in values if isinstance(value, str)}


def test_documented_finding_levels_match_the_code() -> None:
    decided = 0
    for path in (path for part in ("compare", "studies") for path in (ROOT / part).rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if not (isinstance(node, ast.Call) and getattr(node.func, "id", "") == "Finding"):
                continue
            given = {"level": ast.Constant("note")} | {each.arg: each.value for each in node.keywords}
            keys = {key for key in constants(given["key"]) if re.fullmatch(r"\w+\.\w+", key)}
            levels = constants(given["level"]) & {"note", *GRADES}
            if keys and levels:  # both are constants there
                due = set().union(*map(levels_of, keys))
                group = {f"{key.partition('.')[0]}.*" for key in keys} & stated_levels().keys()
                # of a group one level at a time, and of a grade that is looked up no constant
                part = group or any(isinstance(each, ast.Subscript) for each in ast.walk(given["level"]))
                assert levels <= due if part else levels == due, ast.unparse(node)
                decided += len(keys)
    assert decided > 60
    lines = {f"{group}.{name.partition(':')[0]}" for group, names in words().items() for name in names}
    assert [each for each in stated_levels() if not fnmatch_filter(lines, each)] == []


@pytest.mark.slow
def test_published_finding_levels_match_the_documentation() -> None:
    seen: set[str] = set()
    studies = ("advice/pier", "advice/tower", "ensemble/p695-2", "fragility/p695", "risk/p695", "validity")
    for folder in studies:
        path = ROOT / "reports" / "published" / folder
        findings = KINDS[read_manifests(path)[0].kind].results_class().load(path).findings()
        assert [each for each in findings if each.level not in levels_of(each.key)] == []
        seen |= {each.level for each in findings}
    assert seen == {"note", *GRADES}


def test_every_comparison_file_and_manifest_key_is_documented(tmp_path: Path) -> None:
    page = (DOCS / "reference" / "results.md").read_text(encoding="utf-8")
    pier = Cylinder(semidiagonal=6.0, tan_alpha=0.2)
    case = Case(pier, initial=InitialState(0.5 * pier.alpha, rolling_rate=0.5), duration=0.1)
    rockwobble.comparison(case, runs=[Run(None, "flat")], workers=1, out=tmp_path)
    written = [path.name for path in tmp_path.iterdir()]
    keys = list(json.loads((tmp_path / "manifest.json").read_text(encoding="utf-8")))
    trace = compare.simulate(case)
    shown = [name for name in COLUMNS if name not in (*OF_FRAMES, *OF_TENDONS)]
    assert list(trace.to_frame().columns) == shown  # all columns of the page
    assert list(trace.passes.columns) == list(PASS_COLUMNS)
    assert len(written) > 4
    assert len(keys) > 8
    missing = [name for name in [*written, *keys] if f"`{name}`" not in page]
    assert [name for name in missing if f"## {name}" not in page] == []


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_short_ask_a_question_and_keep_small_outputs(notebook: Path) -> None:
    assert int(notebook.name[:2]) == 1 + NOTEBOOKS.index(notebook)  # order of reading
    cells = json.loads(notebook.read_text(encoding="utf-8"))["cells"]
    first = "".join(cells[0]["source"])
    assert first.startswith("# ")
    assert re.search(r"^\*\*[^*]+\?\*\*$", first, re.MULTILINE), "it opens with the question that it answers"
    assert len(cells) <= 24
    code = [cell for cell in cells if cell["cell_type"] == "code"]
    assert [cell["id"] for cell in code if cell["execution_count"] is not None] == []
    # `python docs/notebooks/run.py` keeps them, so that a forge shows them
    outputs = [output for cell in code for output in cell["outputs"]]
    assert outputs
    assert [each for each in outputs if each["output_type"] == "error" or each.get("name") == "stderr"] == []
    text = json.dumps(outputs)
    assert "/tmp/" not in text
    assert notebook.stat().st_size < 150_000
    pictures = [output for output in outputs if "image/png" in output.get("data", {})]
    drawn = any(".plot(" in "".join(cell["source"]) for cell in code)
    assert bool(pictures) >= drawn
