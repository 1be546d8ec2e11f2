"""The firmware of one simulated drive: passive, fed with frames and ticks, standard library only."""
