"""What is published says what its tables hold, was made by committed code, and by code that does the same."""

from __future__ import annotations

import json
from pathlib import Path

import pandas as pd
import pytest

from rockwobble.compare.certificate.verdict import CHANGED
from rockwobble.compare.storage.manifest import MANIFEST, file_state, read_manifests
from rockwobble.compare.storage.provenance import code_digests
from rockwobble.compare.studies.validity.limits import needs
from rockwobble.compare.studies.validity.study import Validity
from rockwobble.models.diagnostic import CODES, parted
from rockwobble.reports.cli.main import main
from rockwobble.reports.pages import KINDS, stored_page

PUBLISHED = Path(__file__).parents[2] / "reports" / "published"
LARGEST = 200_000  # [bytes] of a table, as in remake.py
FOLDERS = sorted(path.parent for path in PUBLISHED.rglob(MANIFEST))
WHOLE = [
    (folder, each.kind)
    for folder in FOLDERS
    for each in read_manifests(folder)
    if each.kind in KINDS and all(file_state(folder, each, name) == "whole" for name in each.files)
]


def name_of(value: object) -> str:
    return value.relative_to(PUBLISHED).as_posix() if isinstance(value, Path) else str(value)


def test_every_study_is_published_and_most_of_them_whole() -> None:
    kinds = {each.kind for folder in FOLDERS for each in read_manifests(folder)}
    studies = set(KINDS) - {"run", "sweep", "view"}
    assert kinds == studies
    # these lack their samples or cells, which are large
    assert {kind for _, kind in WHOLE} == studies - {"comparison", "overturning spectrum", "paper"}


@pytest.mark.parametrize("folder", FOLDERS, ids=name_of)
def test_it_was_made_by_committed_code_and_nothing_is_damaged(folder: Path) -> None:
    for each in read_manifests(folder):
        assert len(each.commit) == 40  # and no "+": the code was as committed
        assert [name for name in each.files if file_state(folder, each, name) == "damaged"] == []
        assert each.headline


def test_what_is_not_kept_is_made_by_the_command_of_its_page() -> None:
    silent = []
    for folder in FOLDERS:
        for each in read_manifests(folder):
            lacking = [name for name in each.files if file_state(folder, each, name) == "missing"]
            pages = [path for name in each.pages if (path := folder / name).suffix == ".md" and path.exists()]
            if lacking:
                silent += [
                    path for path in pages if f"`{each.command}`" not in path.read_text(encoding="utf-8")
                ]
    assert silent == []
    large = [path for path in PUBLISHED.rglob("*.parquet") if path.stat().st_size > LARGEST]
    assert large == []


def test_all_studies_are_of_one_commit() -> None:
    made = [each for folder in FOLDERS for each in read_manifests(folder)]
    # releases of engines are measured in environments of their own, by a script
    assert len({each.commit for each in made if each.kind != "engine versions"}) == 1


@pytest.mark.parametrize("folder", FOLDERS, ids=name_of)
def test_it_is_not_older_than_the_code_that_it_rests_on(folder: Path) -> None:
    current = code_digests()
    older = {
        name for each in read_manifests(folder) for name in each.code if each.code[name] != current[name]
    }
    if older:  # no error: the certificates below say whether results move
        pytest.xfail(f"{name_of(folder)} is older than {', '.join(sorted(older))}; remake.py makes it again")


@pytest.mark.parametrize(("folder", "kind"), WHOLE, ids=name_of)
def test_its_words_are_what_its_tables_say_today(folder: Path, kind: str) -> None:
    page = stored_page(kind, folder)
    words = page.markdown()
    assert r"\*" not in words  # emphasis that would be read as asterisks
    assert (folder / f"{page.name}.md").read_text(encoding="utf-8") == words


@pytest.mark.parametrize("path", sorted(PUBLISHED.rglob("*.parquet")), ids=name_of)
def test_its_diagnostics_are_codes(path: Path) -> None:
    table = pd.read_parquet(path)
    for cell in table.get("diagnostics", []):
        assert set(parted(cell)) <= set(CODES)


def test_the_guide_states_the_needs_of_the_published_limits() -> None:
    found = needs(Validity.load(PUBLISHED / "validity").tables)
    guide = (PUBLISHED.parents[1] / "docs" / "guide" / "limits.md").read_text(encoding="utf-8")
    for name in ("friction", "moment"):
        heads = [f"{each:g}" for each in sorted(found["intensity"].unique())]
        lines = [["tan α", *heads]]
        for tan_alpha, own in found.groupby("tan_alpha"):
            known = {f"{row['intensity']:g}": f"{row[name]:.3g}" for row in own.to_dict("records")}
            lines.append([f"{tan_alpha:g}", *(known.get(head, "–") for head in heads)])
        head, *rows = (f"| {' | '.join(line)} |" for line in lines)
        assert head in guide
        assert "\n".join(rows) in guide


@pytest.mark.parametrize("name", ["reduced", "mujoco"])
def test_the_code_still_does_what_it_did_then(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        main(["verify", str(PUBLISHED / "certificates" / f"{name}.json"), "--json"])
    assert json.loads(capsys.readouterr().out)["word"] != CHANGED
