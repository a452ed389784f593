"""The pages of the study: advice."""
