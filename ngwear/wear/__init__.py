"""Worn depth from an accepted equilibrium, and the size of the next wear step."""
