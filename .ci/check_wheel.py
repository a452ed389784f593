"""Compare what a wheel contains with the files of the checkout: all that is needed and nothing else."""

from __future__ import annotations

import sys
import zipfile
from pathlib import Path

FOLDERS = ("models", "reduced", "multibody", "compare", "studies", "reports")


def main(checkout: Path, wheel: Path) -> None:
    """Exit with a message unless the wheel holds its folders, and nothing but them and the top level."""
    wanted = {
        f"rockwobble/{path.relative_to(checkout).as_posix()}"
        for folder in FOLDERS
        for path in (checkout / folder).rglob("*")
        if path.is_file() and "__pycache__" not in path.parts and "published" not in path.parts
    }
    wanted |= {f"rockwobble/{name}" for name in ("__init__.py", "__init__.pyi", "__main__.py", "py.typed")}
    packed = {name for name in zipfile.ZipFile(wheel).namelist() if ".dist-info/" not in name}
    problems = [f"missing: {name}" for name in sorted(wanted - packed)]
    problems += [f"not wanted: {name}" for name in sorted(packed - wanted)]
    if problems:
        sys.exit("\n".join([f"{wheel.name} does not hold what it should", *problems]))
    print(f"{wheel.name}: {len(packed)} files, {wheel.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
