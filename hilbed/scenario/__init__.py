"""Scenarios: models with file:line errors, bundled files, and checks across the parts."""
