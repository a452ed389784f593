"""What writes reports/published/benchmark: definitions of the ten cases, and their certified references."""
