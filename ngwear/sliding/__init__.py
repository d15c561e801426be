"""Sliding on viscoelastic rubber: hysteresis friction (cases C1 and C2 of 10.5772/50498)."""
