"""The report on the limits of the two-degree-of-freedom model."""
