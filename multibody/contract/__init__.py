"""The contract of an engine: rules of physics that any engine must obey.

Each rule runs one engine with one support and raises an AssertionError that says what was found.
"""
