"""Errors of a run: coarser runs beside it, runs to a given error, and what accuracy costs."""
