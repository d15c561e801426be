"""The sum of all terms as one nonlinear problem, its Newton solver and load stepping."""
