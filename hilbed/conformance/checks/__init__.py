"""The checks, each a function of the drive under test that yields what it finds."""
