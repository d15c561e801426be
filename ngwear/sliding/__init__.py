"""Sliding on rubber that remembers: friction from its memory (cases C1 and C2)."""
