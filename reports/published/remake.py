"""Rebuild the published results, each study by its command or script, from one commit.

    python reports/published/remake.py               # all of it, some two hours on two cores
    python reports/published/remake.py tradeoff paper
    python reports/published/remake.py --redraw      # draw pages and figures again from their tables
    python reports/published/remake.py --check       # is anything damaged, or said without a table?
    python reports/published/remake.py --trim        # leave out what is not kept, without any run
    python reports/published/remake.py --age         # what has changed since in the code that they rest on
    python reports/published/remake.py --archive benchmark.zip   # the benchmark, for who has not the project

An interrupted study resumes. Kept are pages, figures, headline numbers and tables of up to 200 kB; while all
tables of a study are, `rockwobble report reports/published/NAME` draws its pages again without any run; of a
study that is a script, `reports/published/NAME/make.py --redraw`.
"""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
import zipfile
from collections import Counter
from collections.abc import Sequence
from pathlib import Path

from jinja2 import UndefinedError

from rockwobble.compare.storage.manifest import MANIFEST, Manifest, file_state, read_manifests
from rockwobble.compare.storage.provenance import code_digests
from rockwobble.reports.pages import stored_page
from rockwobble.reports.published import headlines
from rockwobble.reports.published.script import not_borne_out
from rockwobble.reports.registry import KINDS

HERE = Path(__file__).parent
# scripts are run by the package of this checkout, whatever is installed
ENVIRONMENT = os.environ | {"PYTHONPATH": str(HERE.parents[1] / "src")}

# of a fragility
_BODIES = (
    "--cylinder pier=6,0.2 --cylinder column=3,0.15 --cylinder tower=10,0.1 "
    "--levels 1.5,2,2.75,3.75,5,6.5,9,12"
)
_ENGINES = (
    "--engine mujoco --engine pybullet --support recess --support flat --support ring "
    "--set ring_clearance=0.01 --set ring_inclination=0.5"
)
# all there are; what loses its contact takes the forces of every run
_LIMITS = " ".join(
    f"--limit {each}"
    for each in (
        "uplift",
        "'0.1 alpha'",
        "'0.25 alpha'",
        "'0.5 alpha'",
        "'1 alpha'",
        "overturned",
        "contact_lost",
    )
)
_SUPPORTS = "--support recess --support flat --support ring"
# folder: command, or script with its options
STUDIES = {
    "compare": "compare compare/el-centro.suite.toml",
    "paper": "make.py",
    "spectrum": "spectrum",
    "advice/pier": "advise",
    "advice/column": "advise --semidiagonal 2 --tan-alpha 0.25 --friction 0.3",
    "advice/tower": "advise --semidiagonal 10 --tan-alpha 0.1",
    "ensemble/p695-2": "ensemble --p695 --peak 2",
    "ensemble/p695-3.5": "ensemble --p695 --peak 3.5 --engine mujoco",
    "ensemble/synthetic-3": "ensemble --synthetic 20 --peak 3",
    "ensemble/copies": f"ensemble --duration 20 {_SUPPORTS}",
    "fragility/p695": f"fragility --p695 {_BODIES} --friction 3 --step-factor 8 {_ENGINES} {_LIMITS}",
    # the control: engines whose numbers hold at half the step
    "fragility/half-step": f"fragility --p695 {_BODIES} --friction 3 --step-factor 4 "
    "--engine mujoco --support recess --support flat --support ring "
    "--set ring_clearance=0.01 --set ring_inclination=0.5",
    "fragility/synthetic": f"fragility --synthetic 2000 --seed 16 {_BODIES}",
    # the hazard: EN 1998-1:2004, 2.1(4), k = 3, 0.3 g once in 475 years
    "risk/p695": "fragility --p695 --cylinder pier=6,0.2 --cylinder column=3,0.15 --cylinder tower=10,0.1 "
    "--levels 1.25,1.5,1.75,2.1,2.5,3,3.6,4.3,5.2,6.3,7.6,9.2,12 --limit overturned --friction 3 "
    "--step-factor 8 --engine mujoco --support recess --support flat --hazard risk/en1998-k3.csv "
    "--hazard-measure pga",
    # the pier above with a tendon that pulls with half its weight, and one weight more for each base radius
    "risk/tendon": "fragility --p695 --cylinder pier=6,0.2 --levels 1.5,2.1,3,4.3,6.3,9.2,13,18 "
    "--limit overturned --friction 3 --step-factor 8 --engine mujoco --support recess "
    "--tendon-prestress 0.5 --tendon-stiffness 1 --hazard risk/en1998-k3.csv --hazard-measure pga",
    "extremes": "make.py",
    "friction_map": "make.py",
    "tradeoff": "make.py --quick",  # the full extent takes an hour of one core
    "validity": "validity",
}
# what the code did that made them: a test fails once it does something else
CERTIFICATES = {"reduced": "certify", "mujoco": "certify --engine mujoco"}
NOT_KEPT = ("*.html", "finished")
# tables once more, as text
SHEETS = ("counts.csv", "counts.json", "members.csv")
# a study with a larger table keeps hardly any: its command makes them again [bytes]
LARGEST = 200_000
# of a study that lacks one, and is drawn no more: what claims of other pages rest on
STILL_KEPT = ("contrasts.parquet", "counts.parquet")
# pages of the control are not shown
CONTROLS = {"fragility/half-step": (*STILL_KEPT, MANIFEST)}

# modules of compare/external that need numpy alone: check.py of the benchmark imports them
_EXTERNAL = ("__init__.py", "table.py", "motion.py", "mistakes.py")

# what `compact` looks for in an SVG
_DRAWN = b'<g id="figure_1">'  # as matplotlib begins, which has its name no more once it is compact
_LEADING = re.compile(rb"(?<!\d)0(?=\.[1-9])")
_PATH, _SEGMENT = re.compile(rb'(?<= d=")[^"]+'), re.compile(rb"([MLQCz])([^MLQCz]*)")
_PLACE, _LONG_NUMBER = re.compile(rb'(?: [xy]="|translate\()[^")]+'), re.compile(rb"(\.\d)\d+")
_NOTHING = re.compile(rb'\n *<!--.*?-->|(?<=\n) +| transform="rotate\(-0 [^"]*"')
_STATED, _NAME = re.compile(rb' style="([^"]*)"'), re.compile(rb' id="([^"]*)"')
_LINK = re.compile(rb'#([^")]+)[")]')


def trim(folder: Path, *, only: tuple[str, ...] | None = None) -> None:
    """Remove files of `folder` that are not published; of a control study all but `only`."""
    for pattern in NOT_KEPT:
        for path in folder.glob(pattern):
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    _drop(folder, SHEETS)
    tables = list(folder.glob("*.parquet"))
    named = [folder / name for made in read_manifests(folder) for name in made.files]
    if (
        only is None
        and not any(path.stat().st_size > LARGEST for path in tables)
        and all(map(Path.exists, named))
    ):
        return
    for path in folder.iterdir():
        table = path.suffix in (".parquet", ".json") and path.name not in (*STILL_KEPT, MANIFEST)
        if path.is_file() and (table if only is None else path.name not in only):
            path.unlink()


def _drop(folder: Path, names: Sequence[str]) -> None:
    """Remove files and their manifest entries."""
    manifest = folder / MANIFEST
    stated = json.loads(manifest.read_text())
    for name in names:
        (folder / name).unlink(missing_ok=True)
        stated["files"].pop(name, None)
    manifest.write_text(json.dumps(stated, indent=1) + "\n")


def compact_all() -> None:
    """Compact all figures drawn by matplotlib."""
    for path in HERE.rglob("*.svg"):
        drawn = path.read_bytes()
        if _DRAWN in drawn:
            path.write_bytes(compact(drawn))


def compact(drawn: bytes) -> bytes:
    """Matplotlib SVG in half the size: shared styles, short paths, only used names."""
    drawn = _NOTHING.sub(b"", _PATH.sub(_short, drawn)).replace(b"<use xlink:href", b"<use href")
    drawn = _PLACE.sub(lambda place: _LONG_NUMBER.sub(rb"\1", place[0]), drawn)
    repeated = [style for style, count in Counter(_STATED.findall(drawn)).items() if count > 2]
    classes = {style: b"s%d" % number for number, style in enumerate(repeated)}
    links, named = dict.fromkeys(_LINK.findall(drawn)), {*_NAME.findall(drawn)}
    names = {name: b"n%d" % number for number, name in enumerate(filter(named.__contains__, links))}
    drawn = _NAME.sub(lambda name: b' id="%s"' % names[name[1]] if name[1] in names else b"", drawn)
    drawn = _LINK.sub(lambda link: link[0].replace(link[1], names.get(link[1], link[1])), drawn)
    drawn = _STATED.sub(lambda one: b' class="%s"' % classes[one[1]] if one[1] in classes else one[0], drawn)
    rules = b"".join(b"\n.%s{%s}" % (name, style) for style, name in classes.items())
    return _ungrouped(drawn.replace(b"</style>", rules + b"</style>", 1))


def _ungrouped(drawn: bytes) -> bytes:
    """SVG with one tag per line, without groups that carry no attribute."""
    kept, bare = [], []
    for line in drawn.split(b"\n"):
        if line.startswith((b"<g>", b"<g ")) and not line.endswith(b"/>"):
            bare.append(line == b"<g>")
        if line not in (b"<g>", b"<g/>") and not (line == b"</g>" and bare.pop()):
            kept.append(line)
    return b"\n".join(kept)


def _short(path: re.Match[bytes]) -> bytes:
    """Path with relative segments in tenths of a point, an eighth of a pixel."""
    segments, here, last = b"", (0, 0), b""
    for letter, numbers in _SEGMENT.findall(path[0]):
        tenths = [round(10.0 * float(number)) for number in numbers.split()]
        places = list(zip(tenths[::2], tenths[1::2], strict=True))
        x, y = (0, 0) if letter == b"M" else here
        offsets = b" ".join(b"%s %s" % (_tenths(to_x - x), _tenths(to_y - y)) for to_x, to_y in places)
        told = b" " if letter == last != b"M" else letter if letter == b"M" else letter.lower()
        segments += told + offsets
        here, last = places[-1] if places else here, letter
    return segments.replace(b" -", b"-")


def _tenths(count: int) -> bytes:
    return _LEADING.sub(b"", b"%.1f" % (0.1 * count)).removesuffix(b".0") or b"0"


def changes_since() -> dict[str, dict[str, int]]:
    """Return for each folder of results how many commits have changed each package since it was made."""
    entries = {}
    for folder in STUDIES:
        for made in read_manifests(HERE / folder):
            changed = {name: _commits_since(made.commit, name) for name in made.code}
            entries[folder] = {name: count for name, count in changed.items() if count}
    return entries


def _commits_since(commit: str, folder: str) -> int:
    words = ["git", "rev-list", "--count", f"{commit}..HEAD", "--", folder]
    done = subprocess.run(words, cwd=HERE.parents[1], capture_output=True, text=True, check=True)
    return int(done.stdout)


def manifests(place: Path = HERE) -> list[tuple[Path, Manifest]]:
    """Folders of results below `place`, each with the manifest of every kind that it holds."""
    folders = sorted(path.parent for path in place.rglob(MANIFEST))
    return [(folder, each) for folder in folders for each in read_manifests(folder)]


def _is_whole(folder: Path, made: Manifest) -> bool:
    return made.kind in KINDS and all(file_state(folder, made, name) == "whole" for name in made.files)


def faults(place: Path = HERE) -> list[str]:
    """Damaged files below `place`, and page statements that contradict their tables."""
    rows = []
    for folder, made in manifests(place):
        name = f"{folder.relative_to(place).as_posix()} ({made.kind})"
        if len(made.commit) != 40:  # exactly 40 digits, without "+": the code was committed
            rows.append(f"{name}: was not made by committed code")
        rows += [
            f"{name}: {each} is damaged" for each in made.files if file_state(folder, made, each) == "damaged"
        ]
        pages = [path for each in made.pages if (path := folder / each).suffix == ".md" and path.exists()]
        if any(file_state(folder, made, each) == "missing" for each in made.files):
            rows += [
                f"{name}: {page.name} does not give the command that makes what is not kept"
                for page in pages
                if f"`{made.command}`" not in page.read_text(encoding="utf-8")
            ]
        rows += [f"{name}: {each}" for each in _page_faults(folder, made)]
    rows += [
        f"{path.relative_to(place)}: larger than {LARGEST} bytes, a command makes it again"
        for path in place.rglob("*.parquet")
        if path.stat().st_size > LARGEST
    ]
    return rows


def _today(folder: Path, made: Manifest) -> tuple[str, str] | None:
    """Stored page and the page drawn today as text, or None if it cannot be drawn."""
    if not _is_whole(folder, made):
        return None
    try:
        page = stored_page(made.kind, folder)
        return (folder / f"{page.name}.md").read_text(encoding="utf-8"), page.markdown()
    except (KeyError, TypeError, AttributeError, ValueError, UndefinedError):  # of older code, as is said
        return None


def _page_faults(folder: Path, made: Manifest) -> list[str]:
    """Page statements that contradict their tables, by the script of the study if it has one."""
    if made.kind not in KINDS:
        if not (folder / "make.py").exists():
            return ["no command and no make.py draws such results"]
        if any(file_state(folder, made, each) != "whole" for each in made.files):
            return []  # reported above as a fault
        script = [sys.executable, str(folder / "make.py"), "--check"]
        done = subprocess.run(script, env=ENVIRONMENT, capture_output=True, text=True, check=False)
        said = [row.removeprefix("FAULT ") for row in done.stdout.splitlines() if row.startswith("FAULT")]
        return said if done.returncode in (0, 1) and bool(said) == done.returncode else [done.stderr.strip()]
    words = _today(folder, made)
    extra = not_borne_out(*words) if words else []
    return [f"its page says {', '.join(extra)}, its tables do not; --redraw mends it"] * bool(extra)


def ages(place: Path = HERE) -> list[str]:
    """Results older than the code: no fault; `remake.py NAME` rebuilds them."""
    current, rows = code_digests(), []
    for folder, made in manifests(place):
        name = f"{folder.relative_to(place).as_posix()} ({made.kind})"
        if older := sorted(part for part in made.code if made.code[part] != current[part]):
            rows.append(f"{name}: older than {', '.join(older)}")
        if _is_whole(folder, made):
            words = _today(folder, made)
            if words is None:
                rows.append(f"{name}: today's pages ask for more than its tables hold")
            elif words[0] != words[1]:
                rows.append(f"{name}: today's page has other words; --redraw writes them")
    return rows


def check() -> int:
    """Print outdated and faulty results; return 1 with faults."""
    for row in ages():
        print(row)
    wrong = [*faults(), *headlines.faults()]
    for row in wrong:
        print(f"FAULT {row}")
    print(f"{len(manifests())} results, {len(wrong)} faults")
    return 1 if wrong else 0


def redraw() -> None:
    """Redraw the pages of results with complete tables."""
    for folder, made in manifests():
        if all(file_state(folder, made, name) == "whole" for name in made.files):
            script = folder / "make.py"
            words = (
                [str(script), "--redraw"] if script.exists() else ["-m", "rockwobble", "report", str(folder)]
            )
            subprocess.run([sys.executable, *words], cwd=HERE, env=ENVIRONMENT, check=True)
            trim(folder)
    compact_all()


def archive(path: Path) -> None:
    """Pack the benchmark with the project modules that its programs import."""
    root, benchmark = HERE.parents[1], HERE / "benchmark"
    files = {path.relative_to(HERE): path for path in benchmark.rglob("*") if "__pycache__" not in path.parts}
    files |= {Path("benchmark/external") / name: root / "compare/external" / name for name in _EXTERNAL}
    files[Path("benchmark/verdict.py")] = root / "compare/check/verdict.py"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, source in sorted(files.items()):
            packed.write(source, name)


def main() -> int:
    """Run the commands of the named studies, or of all."""
    if "--archive" in sys.argv:
        archive(Path(sys.argv[-1]))
        return 0
    if "--check" in sys.argv:
        return check()
    if "--redraw" in sys.argv:
        redraw()
        return 0
    if "--trim" in sys.argv:
        for folder in STUDIES:
            trim(HERE / folder, only=CONTROLS.get(folder))
        compact_all()
        return 0
    if "--age" in sys.argv:
        for folder, changes in changes_since().items():
            said = ", ".join(f"{count} commits in {name}" for name, count in changes.items())
            print(f"{folder}: {said or 'up to date'}")
        return 0
    chosen = sys.argv[1:] or list(STUDIES)
    unknown = [name for name in chosen if not any(name in (each, each.split("/")[0]) for each in STUDIES)]
    if unknown:
        print(f"studies are {', '.join(STUDIES)}, got {', '.join(unknown)}", file=sys.stderr)
        return 2
    changed = subprocess.run(
        ["git", "status", "--porcelain", "-uno", "--", ".", ":!reports/published"],
        cwd=HERE.parents[1], capture_output=True, text=True, check=True,
    ).stdout  # fmt: skip
    if changed:
        print(f"commit first, so that the results can say what made them:\n{changed}", file=sys.stderr)
        return 2
    for folder, command in STUDIES.items():
        if folder not in chosen and folder.split("/")[0] not in chosen:
            continue
        begin = time.monotonic()
        print(f"=== {folder}: {command}", flush=True)
        words = shlex.split(command)
        if words[0] == "make.py":
            words[0] = f"{folder}/make.py"
        else:
            words = ["-m", "rockwobble", *words, "--out", folder, "--overwrite"]
        subprocess.run([sys.executable, *words], cwd=HERE, env=ENVIRONMENT, check=True)
        if words[0] == "-m":  # module command, which draws a page without document
            subprocess.run(
                [sys.executable, "-m", "rockwobble", "report", folder], cwd=HERE, env=ENVIRONMENT, check=True
            )
        trim(HERE / folder, only=CONTROLS.get(folder))
        compact_all()
        print(f"=== {folder}: {time.monotonic() - begin:.0f} s", flush=True)
    (HERE / "certificates").mkdir(exist_ok=True)
    for name, command in CERTIFICATES.items():
        words = [*command.split(), "--out", f"certificates/{name}.json", "--overwrite"]
        subprocess.run([sys.executable, "-m", "rockwobble", *words], cwd=HERE, env=ENVIRONMENT, check=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
