"""Fragility: probability of exceeding a limit, given an intensity, by several methods."""
