"""Controllers and the reference paths that they follow."""
