"""Physical effects, one in each file; an effect that a scene does not list adds nothing to its equations."""
