"""Where the two-degree-of-freedom model may be trusted: measured maps, and limits drawn from them."""
