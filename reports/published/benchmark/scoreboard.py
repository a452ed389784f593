"""Make scoreboard.json, scoreboard.md and scoreboard.html from the folders in results/; needs Python alone.

    python scoreboard.py

A folder results/NAME has about.json (README.md says what it holds) and for each case that was run the
result.json of check.py, as CASE.json. A result that belongs to other references than those here is refused.
"""

from __future__ import annotations

import hashlib
import html
import json
from pathlib import Path
from typing import Any

HERE = Path(__file__).resolve().parent
ORDER = ("exact", "good", "pass", "fail", "rejected")


def entries() -> list[dict[str, Any]]:
    """One entry for each folder of results."""
    digests = {
        path.parent.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in HERE.glob("cases/*/reference.json")
    }
    results = []
    for about in sorted(HERE.glob("results/*/about.json")):
        cases = {}
        for path in sorted(about.parent.glob("*.json")):
            if path == about:
                continue
            result = json.loads(path.read_text("utf-8"))
            if result["reference_sha256"] != digests.get(result["case"]):
                raise SystemExit(
                    f"{path.relative_to(HERE)} was judged by other references: run check.py again"
                )
            told = [one for one in result["criteria"] if one["run"]]
            worst = max(told, key=_share, default=None)
            cases[result["case"]] = {
                "verdict": result["verdict"],
                "worst": worst and {key: worst[key] for key in ("name", "error", "unit", "run")},
                "not_given": [one["name"] for one in result["criteria"] if not one["run"]],
                "likely_mistakes": result["likely_mistakes"],
            }
        results.append({**json.loads(about.read_text("utf-8")), "cases": cases})
    most: dict[str, int] = {}
    for entry in results:
        most[entry["code"]] = max(passes(entry), most.get(entry["code"], 0))
    return sorted(results, key=lambda entry: (-most[entry["code"]], entry["code"], entry["settings"]))


def passes(entry: dict[str, Any]) -> int:
    """Number of cases run that an entry passes."""
    return sum(one["verdict"] in ORDER[:3] for one in entry["cases"].values())


def _share(one: dict[str, Any]) -> float:
    """Error over its bound for a pass."""
    return float("inf") if one["error"] is None else float(one["error"] / one["bounds"][-1])


def cell(entry: dict[str, Any], case: str) -> str:
    """Verdict and worst error, or the reason for none."""
    one = entry["cases"].get(case)
    if one is None:
        known = (word for word in ("cannot", "left_out") if case in entry.get(word, {}))
        return next(known, "not_run").replace("_", " ")
    worst = one["worst"]
    if worst is None or worst["error"] is None:
        return str(one["verdict"])
    until = entry.get("extrapolated_until", {}).get(case)
    limit = "" if until is None else f"; extrapolated to {until:.2g} s" if until else "; not extrapolated"
    name = worst["name"].replace("_", " ")
    return f"{one['verdict']} ({name} {worst['error']:.1e} {worst['unit']}{limit})"


def rows(results: list[dict[str, Any]]) -> list[list[str]]:
    """Table with one row per entry, highest pass share first, and one column per case."""
    titles = {
        path.parent.name: json.loads(path.read_text("utf-8"))["title"]
        for path in HERE.glob("cases/*/case.json")
    }
    head = ["code", "passes", *(titles[case] for case in sorted(titles))]
    body = [
        [
            f"{entry['code']} {entry['version']}, {entry['settings']}",
            f"{passes(entry)} of {len(entry['cases'])}",
            *(cell(entry, case) for case in sorted(titles)),
        ]
        for entry in results
    ]
    return [head, *body]


def makers(results: list[dict[str, Any]]) -> list[list[str]]:
    """Table of the entries, one row each: version, settings, cost, machine and commits."""
    lines = [["code", "version", "settings", "time step", "processor time of a step", "machine", "commits"]]
    for entry in results:
        cost = entry["seconds_a_step"]
        told = [str(entry.get(key, "")) for key in ("code", "version", "settings", "time_step")]
        spent = "" if cost is None else f"{1e6 * cost:.1f} µs"
        commits = ", ".join(sorted({one[:8] for one in entry.get("commits", {}).values()}))
        lines.append([*told, spent, str(entry.get("machine", "")), commits])
    return lines


def markdown(table: list[list[str]]) -> str:
    """Table in Markdown."""
    head, *body = (f"| {' | '.join(row)} |" for row in table)
    return "\n".join([head, "|" + "---|" * len(table[0]), *body])


def page(table: list[list[str]]) -> str:
    """Table in HTML, which scrolls by itself where a screen is narrow."""
    head, *body = table
    text = ["<tr>", *(f"<th>{html.escape(one)}</th>" for one in head), "</tr>"]
    for first, *row in body:
        text.append(f"<tr><th>{html.escape(first)}</th>")
        for one in row:
            word, *more = html.escape(one).split(" (", 1)
            kind = word if word in ORDER else "none"
            below = (
                f"{word}<br><small>{more[0].removesuffix(')')}</small>" if kind != "none" and more else one
            )
            text.append(f'<td class="{kind}">{below}</td>')
        text.append("</tr>")
    return f"<div><table>{''.join(text)}</table></div>"


def main() -> None:
    """Write the three files."""
    results = entries()
    table, made = rows(results), makers(results)
    lines = ",\n ".join(map(json.dumps, results))
    (HERE / "scoreboard.json").write_text(f"[\n {lines}\n]\n", "utf-8")
    words = (
        "Passes: of the cases that a code ran. "
        "Each cell has the verdict of check.py and, of all criteria of the case, the error that is largest "
        'against its bound. "cannot": the code says that it has no such support or start; "left out": its '
        'runs last too long; "not run": nobody has. "extrapolated to": in one of the runs of the case '
        "halving the step brought it no closer from then on, as in single precision; the rest, or all that "
        'is "not extrapolated", is the run at the finest step. '
        "Single peaks and times mean what README.md says."
    )
    text = ["# Scoreboard", words, markdown(table), "## What was run", markdown(made)]
    (HERE / "scoreboard.md").write_text("\n\n".join(text) + "\n", "utf-8")
    style = (
        "body{font:15px/1.45 sans-serif;margin:1.5em;color:#222;background:#fff}p{max-width:45em}"
        "div{overflow-x:auto}table{border-collapse:separate;border-spacing:0}"
        "td,th{border:solid #bbb;border-width:0 1px 1px 0;padding:.4em .6em;text-align:left;"
        "vertical-align:top}td{min-width:6.5em}small{color:#444}"
        "tr:first-child>*{border-top-width:1px}tr>:first-child{border-left-width:1px;position:sticky;left:0;"
        "background:#f3f3f3;min-width:8em}.exact,.good{background:#e2f2e4}.pass{background:#f4f7dc}"
        ".fail,.rejected{background:#f9e0dc}"
        "@media(max-width:600px){body{margin:.8em;font-size:14px}tr>:first-child{max-width:8em}}"
    )
    start = (
        '<!doctype html><html lang="en"><meta charset="utf-8">'
        '<meta name="viewport" content="width=device-width,initial-scale=1">'
        f"<title>Scoreboard</title><style>{style}</style>"
    )
    whole = (
        f"{start}<h1>Scoreboard</h1><p>{html.escape(words)}</p>{page(table)}"
        f"<h2>What was run</h2>{page(made)}</html>\n"
    )
    (HERE / "scoreboard.html").write_text(whole, "utf-8")


if __name__ == "__main__":
    main()
