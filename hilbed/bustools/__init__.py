"""Looking at a bus: who is on it, what they say, and how to read it."""
