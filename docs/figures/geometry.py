"""Draw the geometry: `python docs/figures/geometry.py` writes geometry.svg and frame.svg beside itself.

The recess model: left the vertical section through contact point and mass centre, right the view from above.
The frame: a section through one row of its columns, with the slab where their tops carry it. Every point is
computed from equations (8) and (10), so that the drawings cannot disagree with the equations.
"""

from __future__ import annotations

import math
from pathlib import Path

B, H = 1.0, 2.3  # base radius and half height, of the drawing
TILT, AZIMUTH = math.radians(21.0), math.radians(40.0)
CLOSE, WIDE = 66.0, 108.0  # pixels for a unit of length, from the side and from above
SIDE, ABOVE = (165.0, 385.0), (560.0, 235.0)  # the point O in either view [pixel]
FRAME = (140.0, 385.0)  # the same of the first column of the frame
SPACING = 3.1  # of the columns of the frame
INK, SOFT, BODY, RED, BLUE = "#1b1f23", "#7a828a", "#e9e4d6", "#a63a1e", "#1f5a96"

Point = tuple[float, float]


def place(origin: Point, x: float, y: float) -> Point:
    """Return the pixel of a point (x right, y up) about `origin`."""
    scale = WIDE if origin == ABOVE else CLOSE
    return origin[0] + scale * x, origin[1] - scale * y


def line(
    start: Point, end: Point, *, colour: str = INK, width: float = 1.4, dash: str = "", arrow: str = ""
) -> str:
    """Return a straight line, with a head at its end if `arrow` names one."""
    more = f' stroke-dasharray="{dash}"' if dash else ""
    more += f' marker-end="url(#{arrow})"' if arrow else ""
    return (
        f'<line x1="{start[0]:.1f}" y1="{start[1]:.1f}" x2="{end[0]:.1f}" y2="{end[1]:.1f}" '
        f'stroke="{colour}" stroke-width="{width}"{more}/>'
    )


def polygon(points: list[Point]) -> str:
    """Return a closed outline in the colour of the body."""
    where = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    return f'<polygon points="{where}" fill="{BODY}" stroke="{INK}" stroke-width="1.4"/>'


def arc(centre: Point, radius: float, start: float, end: float, colour: str) -> str:
    """Return an arc about `centre` from one direction to another, counter-clockwise from x [rad]."""
    x0, y0 = centre[0] + radius * math.cos(start), centre[1] - radius * math.sin(start)
    x1, y1 = centre[0] + radius * math.cos(end), centre[1] - radius * math.sin(end)
    path = f"M{x0:.1f} {y0:.1f} A{radius} {radius} 0 0 {int(end < start)} {x1:.1f} {y1:.1f}"
    return f'<path d="{path}" fill="none" stroke="{colour}" stroke-width="1.4"/>'


def dot(where: Point, colour: str = INK) -> str:
    """Return a point."""
    return f'<circle cx="{where[0]:.1f}" cy="{where[1]:.1f}" r="3.4" fill="{colour}"/>'


def label(
    where: Point, words: str, *, shift: Point = (0.0, 0.0), colour: str = INK, plain: bool = False
) -> str:
    """Return a text that begins beside `where`."""
    style = "" if plain else ' font-style="italic"'
    x, y = where[0] + shift[0], where[1] + shift[1]
    return f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}"{style}>{words}</text>'


def seen_from_the_side() -> list[str]:
    """Return the section: along the contact azimuth to the right, up."""
    s, c = math.sin(TILT), math.cos(TILT)
    base = (B * (1 - c), B * s)  # (10)
    mass = (base[0] + H * s, base[1] + H * c)  # (8)

    def at(along_base: float, along_axis: float) -> Point:
        return place(
            SIDE, base[0] + along_base * c + along_axis * s, base[1] - along_base * s + along_axis * c
        )

    origin, contact, centre, middle = place(SIDE, 0, 0), at(B, 0), place(SIDE, *mass), place(SIDE, *base)
    ground = place(SIDE, -2.0, 0), place(SIDE, 2.4, 0)
    return [
        line(*ground, width=2.2),
        polygon([at(-B, 0), at(B, 0), at(B, 2 * H), at(-B, 2 * H)]),
        # where it stood
        line(place(SIDE, -B, 0), place(SIDE, -B, 0.55), colour=SOFT, dash="4 4"),
        line(place(SIDE, B, 0), place(SIDE, B, 0.55), colour=SOFT, dash="4 4"),
        line(middle, place(SIDE, base[0], base[1] + 2.0), colour=SOFT, dash="4 4"),
        line(middle, centre, colour=BLUE),
        line(contact, centre, colour=RED),
        line(middle, contact, colour=BLUE),
        arc(middle, 96.0, math.pi / 2, math.pi / 2 - TILT, INK),
        label(middle, "θ", shift=(12.0, -102.0)),
        arc(centre, 58.0, -math.pi / 2 - TILT, -math.pi / 2 - TILT + math.atan2(B, H), RED),
        label(centre, "α", shift=(-16.0, 80.0), colour=RED),
        *(dot(point) for point in (origin, contact, centre, middle)),
        label(origin, "O", shift=(-6.0, 20.0)),
        label(contact, "T", shift=(0.0, 20.0)),
        label(centre, "S", shift=(9.0, 2.0)),
        label(middle, "B", shift=(-18.0, -2.0)),
        label(at(0.0, 0.36 * H), "h", shift=(8.0, 6.0), colour=BLUE),
        label(at(0.55, 0.0), "b", shift=(-2.0, -7.0), colour=BLUE),
        label(at(0.55, 0.45 * H), "R", shift=(8.0, 4.0), colour=RED),
        label(
            (SIDE[0] - 135.0, SIDE[1] + 52.0), "section through the axis and the contact point", plain=True
        ),
    ]


def seen_from_above() -> list[str]:
    """Return the view from above: x to the right, y up."""
    s, c = math.sin(TILT), math.cos(TILT)
    out = math.cos(AZIMUTH), math.sin(AZIMUTH)
    reach = {"T": B, "B′": B * (1 - c), "S′": B * (1 - c) + H * s}
    at = {name: place(ABOVE, radius * out[0], radius * out[1]) for name, radius in reach.items()}
    contact, radius = at["T"], B * WIDE
    along = contact[0] + 52 * out[0], contact[1] - 52 * out[1]
    across = contact[0] - 52 * out[1], contact[1] - 52 * out[0]
    ring = f'cx="{ABOVE[0]}" cy="{ABOVE[1]}" r="{radius}"'
    circle = f'<circle {ring} fill="{BODY}" stroke="{INK}" stroke-width="1.4"/>'
    return [
        circle,
        line(place(ABOVE, -1.25, 0), place(ABOVE, 1.65, 0), colour=SOFT, arrow="soft"),
        line(place(ABOVE, 0, -1.25), place(ABOVE, 0, 1.65), colour=SOFT, arrow="soft"),
        label(place(ABOVE, 1.65, 0), "x (east)", shift=(-46.0, 22.0), colour=SOFT),
        label(place(ABOVE, 0, 1.65), "y (north)", shift=(8.0, 4.0), colour=SOFT),
        line(ABOVE, at["T"], dash="4 4"),
        line(contact, along, colour=BLUE, arrow="blue"),
        line(contact, across, colour=BLUE, arrow="blue"),
        label(along, "radial", shift=(4.0, 0.0), colour=BLUE, plain=True),
        label(across, "tangential", shift=(-22.0, -8.0), colour=BLUE, plain=True),
        arc(ABOVE, 44.0, 0.0, AZIMUTH, INK),
        label(ABOVE, "φ", shift=(51.0, -12.0)),
        *(dot(point) for point in (ABOVE, *at.values())),
        label(ABOVE, "O", shift=(-18.0, 18.0)),
        label(contact, "T", shift=(8.0, 18.0)),
        label(at["B′"], "B′", shift=(-24.0, -8.0)),
        label(at["S′"], "S′", shift=(-10.0, 22.0)),
        label(
            (ABOVE[0] - 150.0, SIDE[1] + 52.0), "from above; the circle is where the base stood", plain=True
        ),
    ]


def head(name: str, colour: str) -> str:
    """Return the definition of an arrow head."""
    return (
        f'<marker id="{name}" viewBox="0 0 10 10" refX="8" refY="5" markerWidth="7" markerHeight="7" '
        'orient="auto">'
        f'<path d="M0 0 L10 5 L0 10 z" fill="{colour}"/></marker>'
    )


def frame() -> list[str]:
    """Return the section through three columns and the slab; the thin slab is where they stood."""
    s, c = math.sin(TILT), math.cos(TILT)
    base, half, thick = (B * (1 - c), B * s), 1.7, 0.5
    moved, risen = 2 * (B * (1 - c) + half * s), 2 * (B * s + half * c)
    found = [line(place(FRAME, -1.6, 0), place(FRAME, 2 * SPACING + 2.9, 0), width=2.2)]

    def slab(along: float, up: float) -> list[Point]:
        left, right = along - B - 0.15, along + 2 * SPACING + B + 0.15
        corners = (left, up), (right, up), (right, up + thick), (left, up + thick)
        return [place(FRAME, *corner) for corner in corners]

    stood = slab(0.0, 2 * half)
    edges = zip(stood, [*stood[1:], stood[0]], strict=True)
    found += [line(*edge, colour=SOFT, dash="4 4") for edge in edges]
    found.append(polygon(slab(moved, risen)))
    for count in range(3):

        def at(along_base: float, along_axis: float, start: float = count * SPACING) -> Point:
            x = start + base[0] + along_base * c + along_axis * s
            return place(FRAME, x, base[1] - along_base * s + along_axis * c)

        low, high, middle = at(B, 0), at(-B, 2 * half), at(0, half)
        found.append(polygon([at(-B, 0), low, at(B, 2 * half), high]))
        found += [line(low, high, colour=RED), dot(middle), dot(low, RED), dot(high, RED)]
        if count == 0:
            found += [label(middle, "S", shift=(9.0, 2.0)), label(low, "T", shift=(0.0, 20.0))]
            found.append(label(high, "T′", shift=(-26.0, 4.0)))
    start, end = stood[2], slab(moved, risen)[2]
    found += [
        line(start, end, colour=BLUE, arrow="blue"),
        label(end, "2 D along the lean, 2 (z − h) up", shift=(-236.0, -10.0), colour=BLUE, plain=True),
    ]
    return found


def drawing(title: str, parts: list[str], *, definitions: str = "", width: int = 760) -> str:
    """Return a whole drawing as SVG."""
    whole = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} 460" '
        'font-family="Georgia, serif" font-size="17">',
        f"<title>{title}</title>",
        f"<defs>{head('soft', SOFT)}{head('blue', BLUE)}{definitions}</defs>",
        f'<rect width="{width}" height="460" fill="#ffffff"/>',
        *parts,
        "</svg>",
    ]
    return "\n".join(whole) + "\n"


def figures() -> dict[str, str]:
    """Return the drawings by the names of their files."""
    cylinder = seen_from_the_side() + seen_from_above()
    return {
        "geometry": drawing("The tilted cylinder from the side and from above", cylinder),
        "frame": drawing("The tilted frame", frame()),
    }


if __name__ == "__main__":
    for name, words in figures().items():
        Path(__file__).with_name(f"{name}.svg").write_text(words, encoding="utf-8")
