"""The pages of the study: ensemble."""
