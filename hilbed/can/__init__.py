"""The bus: a wire in simulated time, python-can around it, and the CANopen master's side."""
