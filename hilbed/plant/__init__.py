"""The far end of the bus: choppers, motors, shafts and the world they move."""
