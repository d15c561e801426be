"""Comparison of measured profiles of a worn part with a run."""
