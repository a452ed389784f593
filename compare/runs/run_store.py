"""Finished runs in a folder, each found again by what it depends on."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from rockwobble.models import Trace
from rockwobble.models.trace_file import facts_of, trace_of

from ..storage.files import remove_leftovers, sole_writer, write_whole
from ..storage.fingerprint import fingerprint
from ..storage.parquet_file import pack, read
from ..storage.provenance import engine_makers, reduced_makers
from .execution import SAMPLE_STEP, Job

RUNS = "runs"
# runs without their samples but the last: of an ensemble only the numbers count, and it has many members
MEMBERS = "members"


class RunStore:
    """The folder `runs` or `members` in a folder of results: one Parquet file for each finished run.

    A file is named by a hash of the case, the method, the versions of the packages and the code that
    made it. The names of case and run are not part of it: renaming them repeats nothing.

    Parameters
    ----------
    folder : Path
        That of the runs, which exists.
    samples : bool, optional
        Whether all samples are kept, or only the last of them beside the numbers and passes of a run.
    """

    def __init__(self, folder: Path, *, samples: bool = True) -> None:
        self.folder = folder
        self._samples = samples
        self._used: set[Path] = set()

    def find(self, job: Job) -> Trace | None:
        """Return the run of a job if it is there."""
        path = self._path(job)
        if not path.exists():
            return None
        table, about = read(path)
        return dataclasses.replace(trace_of(about["trace"], table, job.case), run=job.run)

    def keep(self, job: Job, trace: Trace) -> None:
        """Keep the run of a job.

        Raises
        ------
        ValueError
            If it cannot be written.
        """
        path = self._path(job)
        about = {
            "kind": "run",
            "case": job.case.name,
            "label": job.label,
            "inputs": path.stem,
            "made with": makers_of(job),
            "trace": facts_of(trace),
        }
        samples = trace.to_frame()
        write_whole(path, pack(samples if self._samples else samples.iloc[-1:], about))

    def remove_others(self) -> None:
        """Remove the runs that nobody has asked for since this store was opened."""
        for path in set(self.folder.glob("*.parquet")) - self._used:
            path.unlink()

    def _path(self, job: Job) -> Path:
        path = self.folder / f"{job_fingerprint(job)}.parquet"
        self._used.add(path)
        return path


@contextmanager
def open_run_store(folder: str | Path, *, samples: bool = True) -> Iterator[RunStore]:
    """Open the finished runs of a folder of results; nobody else can meanwhile.

    What was left half-written is removed. If the block ends well, so are the runs that it did not ask
    for; if it does not, every run is kept.

    Raises
    ------
    ValueError
        If nothing can be written there, or another process has it open.
    """
    path = Path(folder) / (RUNS if samples else MEMBERS)
    with sole_writer(path):
        remove_leftovers(path)
        store = RunStore(path, samples=samples)
        yield store
        store.remove_others()


def makers_of(job: Job) -> dict[str, str]:
    """Return versions and code on which a job depends."""
    return reduced_makers() if job.run.engine is None else engine_makers(job.run.engine)


def job_fingerprint(job: Job) -> str:
    """Return the hash of everything that the result of a job depends on."""
    case, motion = job.case, job.case.motion
    return fingerprint(
        {
            "cylinder": case.cylinder,
            "motion": None if motion is None else (motion.acceleration, motion.time_step),
            "initial": case.initial,
            "length": case.length,
            "gravity": case.gravity,
            "friction": case.friction,
            "method": job.run,
            "sample step": SAMPLE_STEP,
            "made with": makers_of(job),
        }
    )
