"""Recorders: columns, MCAP and candump."""
