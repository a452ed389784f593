"""Draw a cylinder in its recess: `python docs/figures/recess.py` writes recess.svg beside itself.

Seen from a little above. The pose is that of equations (8) and (10), with the tilt enlarged.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from geometry import BLUE, BODY, INK, RED, SOFT, Point, dot, drawing, head, label, line

B, H, DEPTH = 1.0, 2.1, 0.3  # base radius, half height, depth of the recess
TILT, AZIMUTH = math.radians(14.0), math.radians(-18.0)
UP = math.radians(30.0)  # from where it is seen, above the horizontal
SCALE, AT = 78.0, (225.0, 356.0)  # pixels for a unit of length, and of the point O
GROUND, WALL, FLOOR = "#d9dde1", "#8d959d", "#b8bec4"
ROUND = [math.radians(2 * i) for i in range(180)]

Space = tuple[float, float, float]


def seen(point: Space) -> Point:
    """Return the pixel of a point (x right, y away, z up)."""
    x, y, z = point
    return AT[0] + SCALE * x, AT[1] - SCALE * (y * math.sin(UP) + z * math.cos(UP))


def of_body(x: float, y: float, z: float) -> Space:
    """Return where a point of the body is: x from the axis to the contact point, z along the axis."""
    s, c = math.sin(TILT), math.cos(TILT)
    out, up = B * (1 - c) + x * c + z * s, B * s - x * s + z * c  # (8), (10)
    ahead = math.cos(AZIMUTH), math.sin(AZIMUTH)
    return out * ahead[0] - y * ahead[1], out * ahead[1] + y * ahead[0], up


def around(place: Callable[[float, float], Space], start: float = 0.0, end: float = 360.0) -> list[Point]:
    """Return pixels round a circle, from one angle to another [deg]."""
    angles = [math.radians(start + (end - start) * i / 72) for i in range(73)]
    return [seen(place(math.cos(angle), math.sin(angle))) for angle in angles]


def hull(points: list[Point]) -> list[Point]:
    """Return the convex outline of points."""
    whole: list[Point] = []
    for ordered in (sorted(points), sorted(points, reverse=True)):
        half: list[Point] = []
        for point in ordered:
            while len(half) > 1 and _cross(half[-2], half[-1], point) <= 0.0:
                half.pop()
            half.append(point)
        whole += half[:-1]
    return whole


def _cross(a: Point, b: Point, c: Point) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def area(points: list[Point], fill: str, *, edge: str = "none", dash: str = "", clip: str = "") -> str:
    """Return a filled outline."""
    where = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    more = f' stroke-dasharray="{dash}"' if dash else ""
    more += f' clip-path="url(#{clip})"' if clip else ""
    return f'<polygon points="{where}" fill="{fill}" stroke="{edge}" stroke-width="1.3"{more}/>'


def path(points: list[Point], colour: str, *, width: float = 1.3, dash: str = "", arrow: str = "") -> str:
    """Return a line through points, with a head at its end if `arrow` names one."""
    where = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
    more = f' stroke-dasharray="{dash}"' if dash else ""
    more += f' marker-end="url(#{arrow})"' if arrow else ""
    return f'<polyline points="{where}" fill="none" stroke="{colour}" stroke-width="{width}"{more}/>'


def figure() -> str:
    """Return the drawing as SVG."""
    hole = around(lambda x, y: (B * x, B * y, DEPTH))
    near = around(lambda x, y: (B * x, B * y, DEPTH), 180.0, 360.0)
    corners = [seen(corner) for corner in ((-2.7, 1.9, DEPTH), (3.2, 1.9, DEPTH), (2.8, -1.95, DEPTH))]
    corners.append(seen((-2.3, -1.95, DEPTH)))
    stood = hull([seen((B * math.cos(a), B * math.sin(a), z)) for z in (0.0, 2 * H) for a in ROUND])
    body = hull([seen(of_body(B * math.cos(a), B * math.sin(a), z)) for z in (0.0, 2 * H) for a in ROUND])
    top = around(lambda x, y: of_body(B * x, B * y, 2 * H))
    foot, crown, mass = (seen(of_body(0.0, 0.0, z)) for z in (-0.35, 2 * H + 0.55, H))
    upright = seen((0.0, 0.0, DEPTH)), seen((0.0, 0.0, 2 * H + 0.55))
    contact = seen(of_body(B, 0.0, 0.0))
    rolling = around(lambda x, y: (1.35 * B * x, 1.35 * B * y, DEPTH), -140.0, -40.0)
    moved = seen((1.65, 0.4, DEPTH)), seen((2.5, 0.4, DEPTH))
    parts = [
        area(corners, GROUND),
        area(hole, WALL, edge=INK),
        area(around(lambda x, y: (B * x, B * y, 0.0)), FLOOR, clip="hole"),
        area(stood, "none", edge=SOFT, dash="4 4"),
        area(body, BODY, edge=INK),
        area(top, "#f4f1e8", edge=INK),
        # the near side of the ground hides what stands in the recess
        area([*near, (near[-1][0], corners[2][1]), (near[0][0], corners[3][1])], GROUND),
        path(near, INK),
        line(*upright, colour=SOFT, dash="4 4"),
        line(foot, crown, colour=BLUE, dash="7 4"),
        line(contact, mass, colour=RED),
        dot(mass),
        dot(contact, RED),
        path(rolling, BLUE, width=1.8, arrow="blue"),
        label(crown, "θ", shift=(-46.0, 34.0), colour=BLUE),
        label(mass, "R", shift=(26.0, 60.0), colour=RED),
        label(rolling[40], "the rim rolls round: azimuth φ", shift=(-120.0, 24.0), colour=BLUE, plain=True),
        line(moved[1], moved[0], width=2.0, arrow="ink"),
        line(moved[0], moved[1], width=2.0, arrow="ink"),
        label(moved[1], "ground motion", shift=(-58.0, 26.0), plain=True),
    ]
    clip = f'<clipPath id="hole">{area(hole, INK)}</clipPath>'
    return drawing(
        "A cylinder that wobbles in its recess", parts, definitions=head("ink", INK) + clip, width=500
    )


if __name__ == "__main__":
    Path(__file__).with_suffix(".svg").write_text(figure(), encoding="utf-8")
