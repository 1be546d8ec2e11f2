"""A bench for wheeled robots that behaves like a hardware-in-the-loop rig."""

__version__ = "0.1.0"
