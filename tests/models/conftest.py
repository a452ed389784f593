from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

Write = Callable[..., Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Write a text to a file of the given name, byte for byte."""

    def write_file(text: str, name: str = "x.txt") -> Path:
        path = tmp_path / name
        path.write_bytes(text.encode())
        return path

    return write_file
