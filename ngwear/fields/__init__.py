"""Kinematics, integration points, and transfer of fields to another mesh."""
