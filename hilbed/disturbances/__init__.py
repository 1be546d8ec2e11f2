"""Disturbances: one function each, switched on and off by the scenario."""
