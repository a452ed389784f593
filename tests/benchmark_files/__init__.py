"""Writer of reports/published/benchmark: fifteen cases and their certified references."""
