"""Files that are no certificate, or a part of one, are bad input."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from rockwobble.compare.check import verdict
from rockwobble.compare.check.verdict import read_certificate

pytestmark = pytest.mark.checkout

PUBLISHED = Path(__file__).parents[2] / "reports" / "published" / "certificates" / "reduced.json"
HEAD: dict[str, Any] = {"kind": "rockwobble certificate", "format": 3, "method": {}}


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"kind": "something"}, "is no certificate: its kind must be 'rockwobble certificate'"),
        ({"kind": "rockwobble certificate"}, "is no whole certificate: it has no format"),
        (HEAD | {"format": "3"}, "is no whole certificate: it has no format"),
        (HEAD | {"method": None}, "is no whole certificate: it has no method"),
        (HEAD, "is no whole certificate: its fingerprint must be a list of cases"),
        (HEAD | {"fingerprint": [1]}, "is no whole certificate: its fingerprint must be a list of cases"),
        (HEAD | {"fingerprint": [{}]}, "is no whole certificate: it has no .* in case 1 of its fingerprint"),
        (HEAD | {"format": 2}, "has format 2, this version reads 3"),
    ],
)
def test_part_of_a_certificate_is_bad_input(content: dict[str, Any], words: str, tmp_path: Path) -> None:
    (tmp_path / "part.json").write_text(json.dumps(content))
    with pytest.raises(ValueError, match=words):
        read_certificate(tmp_path / "part.json")


def test_two_certificates_of_which_one_is_a_part_are_bad_input(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    part = json.loads(PUBLISHED.read_text())
    del part["fingerprint"][4]["signals"]
    (tmp_path / "part.json").write_text(json.dumps(part))
    assert verdict.main([str(PUBLISHED), str(tmp_path / "part.json")]) == 2
    assert capsys.readouterr().err.strip().endswith("it has no signals in case 5 of its fingerprint")
    assert verdict.main([str(PUBLISHED), str(PUBLISHED)]) == 0
