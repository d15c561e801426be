"""Kinematics of the section, and the move of fields to another mesh."""
