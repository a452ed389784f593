"""Measurements of cost and error, printed as tables: `python tests/benchmarks --help`."""
