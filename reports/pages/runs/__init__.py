"""One run, and what became of many."""
