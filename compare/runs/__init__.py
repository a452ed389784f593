"""Runs: their choice, the scheduler that carries them out, and the cache of finished ones."""
