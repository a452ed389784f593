"""The report of a comparison: its words, rows and tables."""
