"""What any engine must hold, in physics.

Each rule runs one engine with one support and raises an AssertionError that says what was found.
"""
