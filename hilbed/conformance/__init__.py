"""Does a drive do what CiA 402 and its table say? Checks for any velocity drive, simulated or real."""
