"""Advice on one case: how it ends, which of its results to trust, and what the support must supply."""
