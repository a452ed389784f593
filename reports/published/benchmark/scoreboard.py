"""Make scoreboard.json, scoreboard.md and scoreboard.html from the folders in results/; needs Python alone.

    python scoreboard.py

A folder results/NAME has about.json (code, version, settings, seconds_a_step) and for each case that was run
the result.json of check.py, as CASE.json. A result that belongs to other references than those here is
refused.
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
    """Return one entry for each folder of results."""
    digests = {
        path.parent.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in HERE.glob("cases/*/reference.json")
    }
    found = []
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
        found.append({**json.loads(about.read_text("utf-8")), "cases": cases})
    return sorted(
        found, key=lambda entry: -sum(one["verdict"] in ORDER[:3] for one in entry["cases"].values())
    )


def _share(one: dict[str, Any]) -> float:
    """Return an error over its bound for a pass."""
    return float("inf") if one["error"] is None else float(one["error"] / one["bounds"][-1])


def cell(entry: dict[str, Any], case: str) -> str:
    """Return the verdict and the worst error."""
    one = entry["cases"].get(case)
    if one is None:
        return "not run"
    worst = one["worst"]
    if worst is None or worst["error"] is None:
        return str(one["verdict"])
    return f"{one['verdict']} ({worst['name']} {worst['error']:.1e} {worst['unit']})"


def rows(found: list[dict[str, Any]]) -> list[list[str]]:
    """Return the table: a line for each case, a column for each entry."""
    titles = {
        path.parent.name: json.loads(path.read_text("utf-8"))["title"]
        for path in HERE.glob("cases/*/case.json")
    }
    head = ["case", *(f"{entry['code']} {entry['version']}, {entry['settings']}" for entry in found)]
    costs = [entry["seconds_a_step"] for entry in found]
    body = [[titles[case], *(cell(entry, case) for entry in found)] for case in sorted(titles)]
    return [
        head,
        *body,
        ["time of a step", *("" if cost is None else f"{1e6 * cost:.1f} us" for cost in costs)],
    ]


def main() -> None:
    """Write the three files."""
    found = entries()
    table = rows(found)
    (HERE / "scoreboard.json").write_text(json.dumps(found, indent=1) + "\n", "utf-8")
    words = (
        "Each cell has the verdict of check.py and, of all criteria of the case, the error that is largest "
        "against its bound. Single peaks and times mean what README.md says."
    )
    lines = ["# Scoreboard", "", words, "", *(f"| {' | '.join(row)} |" for row in table)]
    lines.insert(5, "|" + "---|" * len(table[0]))
    (HERE / "scoreboard.md").write_text("\n".join(lines) + "\n", "utf-8")
    head, *body = table
    cells = "".join(f"<th>{html.escape(text)}</th>" for text in head)
    page = [f"<tr>{cells}</tr>"]
    for row in body:
        kinds = [next((kind for kind in ORDER if text.startswith(kind)), "none") for text in row]
        pairs = zip(row, kinds, strict=True)
        page.append(
            "<tr>" + "".join(f'<td class="{kind}">{html.escape(text)}</td>' for text, kind in pairs) + "</tr>"
        )
    style = (
        "body{font:15px/1.5 sans-serif;margin:2em}table{border-collapse:collapse}td,th{border:1px solid #bbb;"
        "padding:.4em .6em;text-align:left;vertical-align:top}.exact,.good{background:#e2f2e4}"
        ".pass{background:#f4f7dc}.fail,.rejected{background:#f9e0dc}"
    )
    start = f'<!doctype html><html lang="en"><meta charset="utf-8"><title>Scoreboard</title><style>{style}'
    text = f"</style><h1>Scoreboard</h1><p>{html.escape(words)}</p><table>{''.join(page)}</table></html>\n"
    (HERE / "scoreboard.html").write_text(start + text, "utf-8")


if __name__ == "__main__":
    main()
