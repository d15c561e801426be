"""Physical effects, one a file: what a scene does not list adds nothing to its equations."""
