"""Faults put into the sources, and what finds them: `rockwobble check` and the tests, scored together.

`listed` holds faults that were chosen by hand, each with the group of checks that finds it; `generated` makes
faults from the sources, a sample of which gives the score.
"""
