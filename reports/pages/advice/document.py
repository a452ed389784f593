"""An advice as a document, from what it stores."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from .statements import GRADE_WORDS

_GLOSSARY = (
    "α: the tilt at which the centre of mass stands over the rim. Recess: held against roll-out, as by a "
    "shallow recess. Rolling: on open ground. Scale: factor on the ground motion as given. Dotted in the "
    "pictures: until where the trace holds, the friction there is, and the case as given. Every number is in "
    "advice.json."
)


def advice_document(record: Mapping[str, Any]) -> str:
    """Return the page of an advice in Markdown; the picture is advice.svg beside it.

    Parameters
    ----------
    record : mapping
        The content of advice.json.
    """
    versions = ", ".join(f"{name} {version}" for name, version in record["versions"].items())
    return "\n\n".join(
        (
            f"# May you use the reduced model for {record['name']}?",
            f"**{record['verdict']}**",
            "\n".join(f"- {text}" for text in record["problem"]),
            "![Tilt, friction, perturbed starts and other scales](advice.svg)",
            "\n".join(_statement(each) for each in record["statements"]),
            _GLOSSARY,
            f"Made by `{record['command']}` on {record['date']}, in {record['seconds']:.0f} s of processor "
            f"time, with {versions}.",
            "",
        )
    )


def _statement(each: Mapping[str, str]) -> str:
    grade = GRADE_WORDS[each["grade"]]
    return f"- **{each['topic']}**{f' ({grade})' if grade else ''}: {each['text']} *Run: {each['run']}.*"
