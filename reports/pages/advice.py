"""Page of an advice: verdict, grades, numbers, demands, pictures, details."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

from rockwobble.models import CLOSED_TILT
from rockwobble.models.finding import GRADES, Finding, Findings, Value
from rockwobble.models.records import p695
from rockwobble.models.support import RECESS, RING, support_named
from rockwobble.multibody import DEFAULT_ENGINE
from rockwobble.studies.advice.advice import Advice
from rockwobble.studies.advice.findings import covering_values
from rockwobble.studies.advice.grades import criterion
from rockwobble.studies.advice.members import COPIES
from rockwobble.studies.advice.scales import planar_shares
from rockwobble.studies.advice.trust import scatter_of

from ..figures.advice import parts_of, pictures
from .cases import conditions
from .command_line import command_line, spectrum_line
from .page import Page, figure_html
from .table import number, scattered
from .wording import lines_of, sentence, statement

_MARKS = dict(zip(GRADES, "✓?!✗", strict=True))
# signature lines of a printed page
_SIGNED = '<p class="signed">Project: <span></span> Checked by: <span></span> Date: <span></span></p>'
# rows of the box of demands, in order; of the moment of a recess also the force on a wall
_DEMANDS = (
    *("friction", "shear", "force", "moment", "wall_force", "shear_and_wall"),
    *("top_friction", "top_shear", "top_force", "tendon"),
)
# units in the box, with W as the weight in its head
_UNITS = {"-": "", "weights": " W", "weights × b": " W b"}
# moving part at the top of a frame and of a cylinder; supporting part of a recess and of flat ground
_TOP = {True: "slab", False: "top"}
_BELOW = {True: "recess", False: "ground"}
# modes of motion stated with the input and not as warnings
_PLAIN = ("mode.rest", "mode.rocks", "mode.rocks_in_one_plane", "mode.no_friction_given")
_OPENING = ("mode", "vertical", "rest", "steel")
# options of an advice that other commands do not have
PLAN = ("mass", "copies", "perturbation", "seed")
Row = dict[str, object]


def page_of(advice: Advice) -> Page:
    """Page of an advice."""
    drawn, findings, facts = list(pictures(advice)), advice.findings(), advice.facts
    opening = [each for each in findings if _opens(each)]
    plain = [each for each in findings if each.key in _PLAIN and advice.moves]
    beside = [*findings.of("compared"), *(each for each in findings.of("vertical") if each not in opening)]
    parts = ("together", "wall")
    acting = [each for part in parts for each in findings.of(part) if each.key not in _DEMAND_DETAILS]
    values = {
        "title": f"{facts['case']}: {verdict(findings)}",
        "about": advice.manifest,
        "moves": advice.moves,
        "drawn": [picture.name for picture in drawn],
        "opening": _said(opening),
        "problem_lines": [
            *_said([*plain, *(each for each in findings if _asked(each))]),
            *(f"{line}." for line in conditions({"gravity": facts["gravity"]})),
        ],
        "cautions": _said(findings.of("caution")),
        "compared": " ".join(_said(beside)),
        "criteria": [
            {"topic": topic, "grade": f"{_MARKS[grade]} {grade}"}
            | {
                "reason": sentence(findings.of(topic)[0]),
                "short": sentence(findings.of(topic)[0], short=True),
            }
            | {each: sentence(criterion(topic, each)) for each in GRADES}
            for topic, grade in advice.grades.items()
        ],
        "part": _TOP["columns" in facts["cylinder"]],
        "numbers": list(_numbers(advice, findings)),
        "place": _BELOW[support_named(facts["support"]).is_recess],
        "weight": " ".join(_said(findings.of("weight"))),
        "weight_short": " ".join(statement(each, short=True) for each in findings.of("weight")),
        "demanded": list(_demand_rows(advice, findings)),
        "demand_columns": list(_demand_columns(advice)),
        "wall": " ".join(
            statement(each, short=True) for each in findings.of("wall") if each.key not in _DEMAND_DETAILS
        ),
        "acting": " ".join(_said([*acting, *(each for each in findings if each.key == "demand.weaker")])),
        "steps": _steps(advice, findings),
        "next": next(iter(_steps(advice, findings, short=True)), ""),
        "groups": _groups(advice, findings),
        "perturbation": facts["perturbation"],
        "seed": facts["seed"],
        "closed": CLOSED_TILT,
        "record_lines": _said(each for each in findings if each.key == "case.records"),
        "demand_lines": _said(each for each in findings if each.key in _DEMAND_DETAILS),
        "checks": _said([*findings.of("evidence"), *findings.of("planar")]),
        "shares": planar_shares(advice.planar) if len(advice.planar) and not advice.yielded else [],
        "assumptions": _said(findings.of("assumption")),
    }
    blocks = {"signed": _SIGNED}
    if advice.moves:
        peaks, details = map(figure_html, parts_of(*drawn))
        blocks |= {"beside": '<div class="beside"><div>', "peaks": f"</div>{peaks}</div>", "details": details}
    return Page(name="advice", template="advice", values=values, pictures=drawn, blocks=blocks)


_DEMAND_DETAILS = ("demand.levels", "wall.moment", "wall.balance")


def verdict(findings: Findings) -> str:
    """Verdict on the cylinder, and on the use of the model."""
    return "; ".join(map(sentence, (*findings.of("verdict"), *findings.of("use"))))


def _said(findings: Any) -> list[str]:
    return [statement(each) for each in findings]


def _asked(finding: Finding) -> bool:
    """Whether a finding describes the input."""
    return finding.key == "steel.couple" or (
        finding.key.startswith("case.") and finding.key != "case.records"
    )


def _opens(finding: Finding) -> bool:
    """Whether a finding is a warning shown at the top."""
    group = finding.key.partition(".")[0]
    if group not in _OPENING or finding.key in (*_PLAIN, "steel.couple"):
        return False
    return group != "vertical" or finding.level != "note"


def _groups(advice: Advice, findings: Findings) -> list[dict[str, Any]]:
    """Rows of the groups with their names."""
    names = {each.runs: sentence(each, short=True) for each in findings.of("group")}
    rows = advice.groups.to_dict("records")
    return [{str(key): value for key, value in row.items()} | {"name": names[row["group"]]} for row in rows]


def _numbers(advice: Advice, findings: Findings) -> Iterator[Row]:
    """Rows of numbers: the run as given, and the tilt that 95 % of each group do not exceed."""
    alpha = math.degrees(advice.cylinder.alpha)

    def row(name: str, overturn: str, covered: str, peak: float, without: str, form: str = ".3g") -> Row:
        sizes = (alpha * peak, advice.top(peak))
        moved = [without if math.isinf(peak) else number(each, form) for each in sizes]
        covered = "" if math.isinf(peak) else covered
        return {"name": name, "overturn": overturn, "covered": covered, "tilt": moved[0], "top": moved[1]}

    fallen = advice.overturned or advice.yields
    ends = _cell("yields" if advice.yields else "overturns" if fallen else "stands")
    copies = advice.members[advice.members["group"] == COPIES]["peak_tilt"]
    digits = scattered(scatter_of(advice.peak, copies), most=3)
    yield row(_cell("as_given"), ends, "", math.inf if fallen else advice.peak, ends, digits)
    for group in _groups(advice, findings):
        known, peak, yields = group["runs"] - group["failed"], group["peak_tilt_95"], group.get("yielded", 0)
        if group["single"]:
            ends = _cell("overturns" if math.isinf(peak) else "stands")
            yield row(group["name"], ends, "", peak, ends)
            continue
        low, high = (number(group[f"chance_{end}"], "percent").removesuffix(" %") for end in ("low", "high"))
        share = f"{group['overturned']} of {known} ({low} to {high} %)"
        covered = _cell("covered", count=group["covered"] or None, count_all=known)
        # "21 of 22" beside "overturns" would read as the overturning count
        without = _cell("yields" if yields else "no_limit" if covered else "overturns")
        share = _cell("yields_in", count=yields, count_all=known) if yields else share
        yield row(group["name"], share, covered, peak, without)


def _cell(name: str, **values: Value) -> str:
    return sentence(Finding(key=f"number.{name}", values=values))


def _demand_rows(advice: Advice, findings: Findings) -> Iterator[Row]:
    """Rows of the design demands as a designer enters them, each with its governing group."""
    rows = {str(row["demand"]): row for row in advice.demands.to_dict("records")}
    missing = {str(each.values["reason"]): each for each in findings.of("demand") if "reason" in each.values}
    if "moment" in rows:
        moment, b = rows["moment"], advice.cylinder.base_radius
        forces = {name: moment[name] / b for name in ("per_tonne", "for_mass")}
        rows["wall_force"] = moment | forces | {"unit": "weights"}
    for demand in (each for each in _DEMANDS if each in rows):
        row, name = rows[demand], lines_of(f"demand.{demand}")[0]
        if math.isnan(row["value"]):
            reason = missing[f"demand_{'moment' if demand == 'wall_force' else demand}"]
            yield {
                "name": name,
                "demand": demand,
                "value": _cell("not_given"),
                "of": sentence(reason, short=True),
            }
            continue
        yield {
            "name": name,
            "demand": demand,
            **_sizes(row, "kNm" if demand == "moment" else "kN"),
            "of": _of(advice, row),
        }


def _sizes(row: Mapping[Any, Any], unit: str) -> Row:
    cells: Row = {"value": f"{number(row['value'])}{_UNITS[row['unit']]}"}
    if not math.isnan(row.get("peak", math.nan)):
        cells["peak"] = f"{number(row['peak'])}{_UNITS[row['unit']]}"
        if not math.isnan(row.get("peak_for_mass", math.nan)):  # an earlier version stated none
            cells["peak"] = f"{_round(row['peak_for_mass'])} {unit}"
    if not math.isnan(row["per_tonne"]):
        cells["tonne"] = f"{_round(row['per_tonne'])} {unit}/t"
        if not math.isnan(row["for_mass"]):
            cells["mass"] = f"{_round(row['for_mass'])} {unit}"
    return cells


def _of(advice: Advice, row: Mapping[Any, Any]) -> str:
    """Count and group of the runs whose demand is covered, with their shaking."""
    return sentence(Finding(key="demand.of", values=covering_values(advice, row)))


def _demand_columns(advice: Advice) -> Iterator[list[str]]:
    """Columns of the design demands; forces of a body only if its mass is given."""
    yield from (["name", "demand", "words"], ["value", "value", "words"], ["tonne", "per tonne", "words"])
    if advice.facts["mass"] is not None:
        yield ["mass", _cell("one_column" if "columns" in advice.facts["cylinder"] else "in_all"), "words"]
    if "peak" in advice.demands and advice.demands["peak"].notna().any():  # an earlier version stated none
        yield ["peak", "peak", "words"]
    yield ["of", "not exceeded by", "words"]


def _round(value: float) -> str:
    """Force with three digits, from 1 up without a power of ten."""
    return f"{float(f'{value:.3g}'):.10g}" if value >= 1.0 else number(value)


def _ratios_of_tendon(advice: Advice) -> dict[str, str]:
    """Options of the tendon as ratios, whichever form the user gave."""
    tendon = advice.facts.get("tendon") or {}
    return {f"tendon_{name}": f"{tendon[name]:.6g}" for name in ("prestress", "stiffness") if name in tendon}


def _steps(advice: Advice, findings: Findings, *, short: bool = False) -> list[str]:
    """Next steps as lines, each with its complete command if it has one."""
    commands = _calls(advice) if advice.facts["options"] is None else _commands(advice)
    return [
        _cell(
            "step",
            detail=statement(each, short=short)[:-1],
            code=commands.get(each.key.partition(".")[2], ""),
        )
        for each in findings.of("step")
    ]


def _calls(advice: Advice) -> dict[str, str]:
    """Python calls for the next steps, where `case` is defined."""
    run = f'rw.Run("{DEFAULT_ENGINE}", "{advice.facts["support"]}")'
    return {
        "friction_unknown": "dataclasses.replace(case, friction=...)",
        "budget": f"rw.comparison(case, runs=[{run}], budget=True)",
        "engine": f"rw.advise(case, {run})",
        "spectrum": f"rw.spectrum({advice.cylinder.tan_alpha:.6g}, case.motion)",
        "ensemble": "rw.ensemble(case)",
        "clearance": f'rw.advise(case, support="{RING}")',
        "in_a_recess": f'rw.advise(case, support="{RECESS}")',
        "vertical": "rw.read_record(x, y, z)",
        "records": p695.REMEDY,
    }


def _commands(advice: Advice) -> dict[str, str]:
    options, support = advice.facts["options"], advice.facts["support"]
    # the mass of a column states a tendon, too
    plan = [name for name in PLAN if name != "mass" or not options.get("tendon_force")]
    problem = {name: value for name, value in options.items() if name not in plan}
    return {
        "friction_unknown": command_line("advise", options | {"friction": "MU"}),
        "budget": command_line("compare", problem | {"support": support, "budget": True}),
        "engine": command_line("advise", options | {"engine": DEFAULT_ENGINE}),
        "spectrum": spectrum_line(options | _ratios_of_tendon(advice), advice.cylinder.tan_alpha),
        "ensemble": command_line("ensemble", problem | {"support": support}),
        "clearance": command_line("advise", options | {"support": RING}),
        "in_a_recess": command_line("advise", options | {"support": RECESS}),
        "vertical": command_line("advise", options | {"record_z": "Z"}),
        "records": p695.REMEDY,
    }
