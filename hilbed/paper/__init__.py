"""`hilbed paper NAME`: all experiments of one paper on one page, in the paper's order."""

from hilbed.paper.catalogue import NAMES, Paper, read

__all__ = ["NAMES", "Paper", "read"]
