"""Font of the formulas: `python docs/figures/math_font.py STIXMath-Regular.otf` writes _static/math.woff.

A browser draws MathML with whatever font it finds, and most machines have none with all sizes of brackets.
The site brings its own: the glyphs of STIX Math 1.1.1 that its formulas use. The licence (SIL OFL 1.1, beside
the font in math-font-license.txt) asks that a changed font has another name.
"""

from __future__ import annotations

import sys
from pathlib import Path

from fontTools.subset import Options, Subsetter, parse_unicodes
from fontTools.ttLib import TTFont

FAMILY = "Rockwobble Math"
CHARACTERS = (
    "20-7E,A0,A8,AF,B0,B1,B7,D7,2C6,2C7,2D8-2DC,300-30C,338,"  # Latin, accents
    "391-3C9,3D1,3D5,3F5,"  # Greek
    "2013,2026,2032,2033,20D7,2061-2063,210E,2190-2194,21D2,"  # primes, invisible operators, arrows
    "2202-2213,2215-221E,2223,2225,2227-222B,2248,2260-226B,22C5,22EF,"  # operators and relations
    "2308-230B,239B-23B3,"  # parts of tall brackets
    "1D400-1D49B,1D6A8-1D755"  # bold, italic and bold italic letters, Latin and Greek
)


def subset(source: Path) -> TTFont:
    """Return the glyphs of `CHARACTERS`, with their larger variants and the constants of layout."""
    font = TTFont(source)
    wanted = Options()
    wanted.layout_features, wanted.hinting, wanted.desubroutinize = ["*"], False, True
    wanted.drop_tables = [*wanted.drop_tables, "FFTM"]
    tool = Subsetter(wanted)
    tool.populate(unicodes=parse_unicodes(CHARACTERS))
    tool.subset(font)
    renamed = {1: FAMILY, 4: FAMILY, 6: FAMILY.replace(" ", "") + "-Regular"}
    for entry in font["name"].names:
        if entry.nameID in renamed:
            entry.string = renamed[entry.nameID]
    font["CFF "].cff.fontNames = [renamed[6]]
    font.flavor = "woff"
    return font


if __name__ == "__main__":
    subset(Path(sys.argv[1])).save(Path(__file__).parents[1] / "_static" / "math.woff")
