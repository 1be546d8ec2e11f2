"""The drive's object dictionary as data: one tuple of objects, in order of their index."""

from __future__ import annotations

from operator import attrgetter

from firmware_sim.entry import Object
from firmware_sim.objects.communication import COMMUNICATION
from firmware_sim.objects.pdo import PDO
from firmware_sim.objects.profile import PROFILE
from firmware_sim.objects.tuning import TUNING

OBJECTS: tuple[Object, ...] = tuple(
    sorted((*COMMUNICATION, *PDO, *TUNING, *PROFILE), key=attrgetter("index"))
)
