"""How an accepted equilibrium becomes a worn body, and how large the next step may be."""
