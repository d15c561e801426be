"""Profiles measured on a worn part beside those that a run has computed."""
