"""Validity of the two-degree-of-freedom model: measured maps, and limits drawn from them."""
