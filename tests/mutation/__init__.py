"""Faults planted in the sources, and their detection by `rockwobble check` and the tests.

`listed` holds faults that were chosen by hand, each with the group of checks that finds it; `generated` makes
faults from the sources, a sample of which gives the score.
"""
