"""The pages of the study: comparison."""
