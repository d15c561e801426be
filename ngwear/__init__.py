"""Friction and abrasive wear of rubber parts on NGSolve and Netgen."""

__version__ = "0.1.0"
