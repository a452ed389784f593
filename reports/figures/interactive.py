"""Pictures as chart data for `charts.js` on pages of any width."""

from __future__ import annotations

import base64
import dataclasses
import html
import json
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import ArrayLike

from .heat import NOTHING, Heat, Shades
from .picture import MOST_ENTRIES, Axis, Layer, Line, Panel, Picture
from .thinning import POINTS, kept_points

_PER_INCH = 125.0  # pixels of height
# numbers in cells as long as a phone has room for them
_MOST_WRITTEN = 42
_COLOURS = 64  # colours of a continuous scale
_EMPTY = 255  # place of a cell without a value and without a reason


def charts(picture: Picture) -> list[tuple[str, str]]:
    """Return title and HTML element of each panel."""
    elements = []
    for index, panel in enumerate(picture.panels):
        # only `</` could end a script
        stated = json.dumps(chart(panel, picture), separators=(",", ":"), ensure_ascii=False).replace(
            "</", "<\\/"
        )
        name = html.escape(f"{picture.name}-{index}")
        script = f'<script type="application/json">{stated}</script>'
        elements.append((panel.title, f'<div class="chart" id="{name}">{script}</div>'))
    return elements


def colour_bar(shades: Shades) -> str:
    """HTML element of the scale of the colours."""
    shown = ", ".join(_palette(shades)) if not shades.steps else ", ".join(_steps(shades))
    ticks = "".join(
        f'<span style="left: {100.0 * at:.4g}%">{html.escape(word)}</span>' for at, word in shades.ticks()
    )
    bar = f'<div style="background: linear-gradient(to right, {shown})"></div>'
    return f'<div class="shades">{bar}<p>{ticks}</p><p>{html.escape(shades.title)}</p></div>'


def chart(panel: Panel, picture: Picture) -> dict[str, object]:
    """Panel as data: plain values, and arrays as base64 of little-endian float32."""
    entries = panel.entries()
    shown = list(entries)[: MOST_ENTRIES - (len(entries) > MOST_ENTRIES)]
    maps = any(isinstance(layer, Heat) for layer in panel.layers)
    return {
        "height": round(_PER_INCH * panel.height),
        "x": _axis(panel.x),
        "y": _axis(panel.y),
        "second": None if panel.second is None else [_axis(panel.second[0]), panel.second[1]],
        "equal": panel.equal,
        "link": picture.panels[0].x.title if picture.link_x else "",
        "ground": NOTHING if maps else "#ffffff",
        "layers": [_layer(layer, panel, picture) for layer in panel.layers],
        "legend": [{"name": name, **entries[name]} for name in shown],
        "more": len(entries) - len(shown),
    }


def base64_of(values: ArrayLike) -> str:
    """Base64 of little-endian float32; seven digits suffice on a screen."""
    return base64.b64encode(np.asarray(values, dtype="<f4").tobytes()).decode()


def _axis(axis: Axis) -> dict[str, object]:
    return {
        "title": axis.title,
        "unit": f" {axis.unit}" if axis.unit not in ("", "-") else "",
        "log": axis.log,
        "low": axis.low,
        "high": axis.high,
        "ticks": [[float(at), word] for at, word in axis.ticks],
        "reverse": axis.reverse,
    }


def _layer(layer: Layer, panel: Panel, picture: Picture) -> dict[str, object]:
    if isinstance(layer, Line):
        return _line(layer, picture.points)
    if isinstance(layer, Heat):
        assert picture.shades is not None
        return _heat(layer, panel, picture.shades)
    fields = dataclasses.asdict(layer).items()
    packed = {name: base64_of(value) if isinstance(value, np.ndarray) else value for name, value in fields}
    return {"kind": type(layer).__name__.lower(), **packed}


def _line(line: Line, points: int) -> dict[str, object]:
    keep = kept_points(line.x, line.y, points=POINTS if line.style.dash == "none" else points)
    filled = (
        np.broadcast_to(line.filled, line.x.shape)[keep]
        if isinstance(line.filled, np.ndarray)
        else line.filled
    )
    return {
        "kind": "line",
        "name": line.name,
        "x": base64_of(line.x[keep]),
        "y": base64_of(line.y[keep]),
        "style": dataclasses.asdict(line.style),
        "width": line.width,
        "size": line.size,
        "opacity": line.opacity,
        "open": np.atleast_1d(np.logical_not(filled)).astype(int).tolist(),
        "steps": line.steps,
        "clip": line.clip,
        "notes": [line.notes[place] for place in keep] if line.notes else [],
    }


def _heat(heat: Heat, panel: Panel, shades: Shades) -> dict[str, object]:
    x, y = heat.edges(log_x=panel.x.log, log_y=panel.y.log)
    palette = _palette(shades)
    known = np.isfinite(heat.values)
    places = shades.place(np.where(known, heat.values, shades.low))
    cells = np.where(known, np.minimum(places * len(palette), len(palette) - 1), _EMPTY).astype(np.uint8)
    gaps = {}
    for number, gap in enumerate(heat.gaps, start=len(palette)):
        cells[gap.cells] = number
        gaps[number] = gap.name
    written = bool(heat.written) and heat.values.size <= _MOST_WRITTEN
    return {
        "kind": "heat",
        "x": base64_of(x),
        "y": base64_of(y),
        "centres": [base64_of(heat.x), base64_of(heat.y)],
        "values": base64_of(heat.values),
        "cells": base64.b64encode(cells.tobytes()).decode(),
        "palette": [*palette, *(gap.colour for gap in heat.gaps)],
        "gaps": gaps,
        "title": shades.title,
        "written": [
            format(value, heat.written) if np.isfinite(value) else "" for value in heat.values.ravel()
        ]
        if written
        else [],
    }


def _palette(shades: Shades) -> Sequence[str]:
    """Colours of the scale from its low end to its high one."""
    from matplotlib.colors import to_hex

    from .svg import colours

    count = shades.steps or _COLOURS
    return [to_hex(colour) for colour in colours(shades)(np.linspace(0.0, 1.0, count))]


def _steps(shades: Shades) -> Iterator[str]:
    """Yield the colour stops of a stepped gradient."""
    palette = _palette(shades)
    for place, colour in enumerate(palette):
        yield f"{colour} {100.0 * place / len(palette):.4g}% {100.0 * (place + 1) / len(palette):.4g}%"
