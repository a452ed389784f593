"""What made a study, in the last line of its document."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rockwobble.compare.storage.origin import Origin


def made_by(origin: Origin) -> str:
    """Return command, day, processor and versions as a sentence in Markdown."""
    versions = ", ".join(f"{name} {version}" for name, version in origin.versions.items())
    return f"Made by `{origin.command}` on {origin.date}, on {origin.processor}, with {versions}."
