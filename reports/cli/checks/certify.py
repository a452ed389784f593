"""`rockwobble certify` and `rockwobble verify`: a certificate of this installation, made or verified."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Annotated

import typer

from ...console.terminal import interruptible, user_input

Out = Annotated[Path, typer.Option(help="File to write.")]
Engine = Annotated[str | None, typer.Option(help="Engine to certify. Default: the reduced models.")]
TimeStep = Annotated[
    float | None, typer.Option(help="Time step of the engine, in s. Default: its own choice.")
]
Only = Annotated[
    list[str] | None,
    typer.Option(
        metavar="GROUP",
        help="Make claims of one group of `rockwobble check`; may be repeated. Default: all but protocol and "
        "baseline.",
    ),
]
CertificateFile = Annotated[Path, typer.Argument(help="File that certify wrote.", show_default=False)]
Json = Annotated[bool, typer.Option("--json", help="Print the answer as JSON.")]


def certify(
    out: Out = Path("certificate.json"),
    engine: Engine = None,
    time_step: TimeStep = None,
    only: Only = None,
) -> None:
    """Write a certificate: claims with their evidence, and a fingerprint of twelve short cases.

    A claim is verified (against exact solutions), cross-validated (between independent formulations) or
    validated (against an experiment, by the hash of its data; there is none yet). Nothing is written where a
    check fails.

    Exit code 0 if it is written, 2 for bad input or a check that fails.
    """
    with interruptible(), user_input():
        from rockwobble.compare.certificate import CLAIMING, models, write_certificate
        from rockwobble.compare.certificate import certify as make
        from rockwobble.compare.check import engine as engine_subject
        from rockwobble.compare.check import reduced_model, run_checks
        from rockwobble.compare.storage.files import require_file
        from rockwobble.models.number_checks import require_one_of

        if time_step is not None and engine is None:
            raise ValueError("--time-step belongs to --engine, got it alone")
        for group in only or ():
            require_one_of("--only", group, CLAIMING)
        require_file("--out", out)
        subject = models() if engine is None else engine_subject(engine, time_step)
        if "recess" not in subject.supports:
            given = f"{engine} with {', '.join(subject.supports)}"
            raise ValueError(f"--engine must have a recess, got {given}")
        checked = subject if engine else reduced_model()
        found = make(subject, run_checks(checked, only or CLAIMING))
        write_certificate(found, out)
    print(f"{out}: {len(found['claims'])} claims, {len(found['fingerprint'])} cases")


def verify(certificate: CertificateFile, as_json: Json = False) -> None:
    """Answer in one word whether this installation still does what a certificate says.

    same: every number repeats. chaotic: what differs does so after agreement must end, and distributions
    agree. changed: something differs before that; the claim and the first term concerned are named.

    Exit code 0 for same and chaotic, 1 for changed, 2 for bad input.
    """
    with interruptible(), user_input():
        from rockwobble.compare.certificate import read_certificate
        from rockwobble.compare.certificate import verify as verdict_on

        verdict = verdict_on(read_certificate(certificate))
    print(json.dumps(asdict(verdict), indent=1) if as_json else verdict.words())
    if verdict.exit_code:
        raise typer.Exit(verdict.exit_code)
