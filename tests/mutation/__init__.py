"""The checks, checked: faults put into the sources, and whether something finds them.

`listed` holds faults that were chosen by hand, each with the layer of `rockwobble check` that must find and
name it; they run in the interpreter, in copies of the reduced models that are never written down. `sites`
generates faults from the sources themselves; each is put into a copy of the whole checkout, where
`rockwobble check` and then the tests are asked. `python tests/mutation --help` runs both.
"""
