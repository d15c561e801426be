"""Processes beside this one, and one function at many points."""
