"""What accuracy costs: ladders of settings, their errors and times, and the cheapest that is accurate enough."""
