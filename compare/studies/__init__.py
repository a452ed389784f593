"""Studies: many runs and what follows from them, one folder each."""
