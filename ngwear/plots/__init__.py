"""Pictures; nothing here computes."""
