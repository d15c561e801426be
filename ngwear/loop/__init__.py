"""The loop: mount, then equilibrium, wear, new outline and new mesh, stroke after stroke, to a run's end."""
