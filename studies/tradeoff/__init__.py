"""Trade-off of speed and accuracy of the reduced models, other solvers and the engines."""
