"""The pages of the study: spectrum."""
