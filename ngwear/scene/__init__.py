"""The scene: the input of a simulation as frozen dataclasses, and its files. No mesh, no solver."""
