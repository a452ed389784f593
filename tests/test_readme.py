"""What the README shows works: its Python, its commands, its links; documents agree on the version."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from typer.testing import CliRunner

CHECKOUT = Path(__file__).parents[1]
README = (CHECKOUT / "README.md").read_text(encoding="utf-8")


pytestmark = pytest.mark.checkout


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```$", README, re.DOTALL | re.MULTILINE)


def commands() -> list[str]:
    lines = [line.split("#")[0].strip() for block in blocks("sh") for line in block.splitlines()]
    calls = [
        call for line in lines for call in re.findall(r"(?:^|&& )(?:\.venv/bin/)?rockwobble ([^&]+)", line)
    ]
    return [call.strip() for call in calls]


@pytest.mark.parametrize("block", blocks("python"))
def test_python_examples_of_the_readme_run(block: str) -> None:
    exec(compile(block, "README.md", "exec"), {"__name__": "readme"})


@pytest.mark.parametrize("command", commands())
def test_commands_exist_with_the_options_shown(command: str) -> None:
    from rockwobble.reports.cli.main import app

    result = CliRunner().invoke(app, [command.split()[0], "--help"])
    assert result.exit_code == 0, result.output
    missing = [option for option in re.findall(r"--[a-z-]+", command) if option not in result.output]
    assert missing == []


def test_the_two_lines_that_set_everything_up_are_there() -> None:
    lines = [
        line.split("#")[0].strip() for block in blocks("sh") for line in block.splitlines() if "venv" in line
    ]
    assert lines == [
        "python3 -m venv .venv && . .venv/bin/activate && pip install . && rockwobble compare",
        "python3 -m venv .venv && .venv/bin/pip install '.[test]' && .venv/bin/pytest",
    ]


def test_links_lead_to_files() -> None:
    targets = [target for target in re.findall(r"\]\(([^)#]+)", README) if "://" not in target]
    assert targets
    assert [target for target in targets if not (CHECKOUT / target).exists()] == []


def test_the_description_for_an_index_has_no_link_into_the_checkout() -> None:
    config = tomllib.loads((CHECKOUT / "pyproject.toml").read_text(encoding="utf-8"))
    described = README
    for each in config["tool"]["hatch"]["metadata"]["hooks"]["fancy-pypi-readme"]["substitutions"]:
        described = re.sub(each["pattern"], each["replacement"], described)
    assert [link for link in re.findall(r"\]\(([^)]+)\)", described) if not link.startswith("https:")] == []
    assert len(described.split()) > 0.9 * len(README.split())


def test_no_document_says_another_version_author_or_address() -> None:
    project = tomllib.loads((CHECKOUT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    citation = (CHECKOUT / "CITATION.cff").read_text(encoding="utf-8")
    released = re.search(
        r"^## \[(\S+)\] - (\S+)", (CHECKOUT / "CHANGELOG.md").read_text(encoding="utf-8"), re.M
    )
    assert released is not None
    assert released[1] == project["version"]
    assert f"date-released: {released[2]}" in citation
    texts = [citation, *(path.read_text(encoding="utf-8") for path in CHECKOUT.glob("*.md"))]
    texts += [path.read_text(encoding="utf-8") for path in (CHECKOUT / "docs").rglob("*.md")]
    said = [each for text in texts for each in re.findall(r"(?<!cff-)\bversion\W+(\d+\.\d+\.\d+)", text)]
    assert len(said) >= 2
    assert set(said) == {project["version"]}
    assert all(f"name: {each['name']}" in citation for each in project["authors"])
    address = re.search(r"^repository-code: (\S+)", citation, re.M)
    assert project.get("urls", {}).get("Source") == (address and address[1])
