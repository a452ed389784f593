"""Comparison of runs with reference models: result, summary, prediction, error budget."""
