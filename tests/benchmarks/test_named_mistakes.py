from __future__ import annotations

import pytest

from benchmarks.named_mistakes import FILES, main


@pytest.mark.parametrize("name", ["R 1 % larger"])
def test_a_mistake_is_named_by_both(name: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--only", name]) == 0
    assert capsys.readouterr().out.count(FILES[name].code) == 3  # what is to be named, and by both
