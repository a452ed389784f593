"""Fragility: probability that a demand exceeds a limit, given an intensity of shaking, by several methods."""
