"""Network management: states, commands and the services that each state allows (CiA 301)."""

from __future__ import annotations

from enum import IntEnum
from types import MappingProxyType
from typing import Final


class NmtState(IntEnum):
    """States, as a heartbeat shows them."""

    INITIALISING = 0
    STOPPED = 4
    OPERATIONAL = 5
    PRE_OPERATIONAL = 127


COMMANDS: Final = MappingProxyType(
    {1: NmtState.OPERATIONAL, 2: NmtState.STOPPED, 128: NmtState.PRE_OPERATIONAL}
)
RESET_NODE: Final = 129
RESET_COMMUNICATION: Final = 130

# States in which SDO and EMCY work; PDO and SYNC need OPERATIONAL.
TALKING: Final = (NmtState.PRE_OPERATIONAL, NmtState.OPERATIONAL)
# State that a communication error leads to, by the value of 1029:1 (1 changes nothing).
ERROR_STATES: Final = MappingProxyType({0: NmtState.PRE_OPERATIONAL, 2: NmtState.STOPPED})
