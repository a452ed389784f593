"""`rockwobble certify` and `rockwobble verify`: a certificate of this installation, made or verified."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import rockwobble as rw

from ...console.progress import shown_progress
from ...console.terminal import interruptible, user_input

if TYPE_CHECKING:
    from rockwobble.compare.check import Finding

# of the checks, those that make claims; with an engine, also those that need its runs
_LAYERS = ("equations", "conserved", "exact", "rest", "invariance", "order", "residual")
_ENGINE_LAYERS = ("traces", "agreement")
Out = Annotated[Path, typer.Option(help="File to write.")]
Engine = Annotated[str | None, typer.Option(help="Certify an engine. Default: the reduced models.")]
TimeStep = Annotated[float | None, typer.Option(help="Of the engine, in s. Default: its own choice.")]
Only = Annotated[
    list[str] | None,
    typer.Option(
        metavar="LAYER",
        help="Make claims of one layer of `rockwobble check`; may be repeated. Default: equations, "
        "conserved, exact, rest, invariance, order, residual, and with --engine traces and agreement.",
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
        from rockwobble.compare.certificate import certify as make
        from rockwobble.compare.certificate import engine_method, reduced_method
        from rockwobble.compare.certificate.certificate import write_certificate
        from rockwobble.compare.certificate.claims import CLAIMING
        from rockwobble.compare.check import LAYERS, Bench, run_checks
        from rockwobble.compare.storage.files import require_file
        from rockwobble.models.number_checks import require_one_of
        from rockwobble.multibody.engines.registry import find_engine

        if time_step is not None and engine is None:
            raise ValueError("--time-step belongs to --engine, got it alone")
        layers = tuple(only or (*_LAYERS, *(_ENGINE_LAYERS if engine else ())))
        for layer in layers:
            require_one_of("--only", layer, LAYERS)
        if silent := [layer for layer in layers if layer not in CLAIMING]:
            able = ", ".join(layer for layer in LAYERS if layer in CLAIMING)
            raise ValueError(f"--only must name layers that make claims ({able}), got {', '.join(silent)}")
        require_file("--out", out)
        method = reduced_method() if engine is None else engine_method(engine, time_step)
        bench = Bench(reduced=rw.reduced, suite=rw.read_suite("quick"))
        # claims of no other engine; those of one whose accuracy is not known rest on the suite
        bench.engines = [name for name in bench.engines if name == engine]
        if engine is not None:
            supports = find_engine(engine).supports
            if "recess" not in supports:
                raise ValueError(f"--engine must have a recess, got {engine} with {', '.join(supports)}")
            runs = [rw.Run(engine, support, time_step) for support in supports]
            bench.suite = rw.Suite(bench.suite.cases, runs, bench.suite.bounds)
        findings: list[Finding] = []
        for layer in layers:
            with shown_progress("engine runs", heading=f"checking {layer}") as bench.progress:
                findings += run_checks(bench, [layer])
        found = make(method, findings)
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
