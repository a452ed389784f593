"""What writes reports/published/benchmark: twelve cases and their certified references."""
