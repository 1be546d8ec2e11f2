"""Robots: their kinematics and what their frames mean."""
