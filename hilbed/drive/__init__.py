"""A whole simulated drive as a process in real time: the stand-in for a drive on the desk."""
