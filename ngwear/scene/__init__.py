"""What is simulated, as plain frozen data, and its files: no mesh, no solver, nothing that runs."""
