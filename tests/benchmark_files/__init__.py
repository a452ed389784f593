"""What writes reports/published/benchmark: eleven cases and their certified references."""
