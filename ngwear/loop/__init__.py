"""The loop of a run: mounting, then for each stroke equilibrium, wear, new outline and, if needed, a new mesh."""
