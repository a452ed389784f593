"""Commands that tell whether models and engines still agree."""
