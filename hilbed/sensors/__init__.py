"""Sensors: sampled at a rate, delivered after a latency, sometimes not at all."""
