"""What writes reports/published/benchmark: thirteen cases and their certified references."""
