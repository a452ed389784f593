"""What accuracy costs: error against computing time of the reduced models, other solvers and the engines."""
