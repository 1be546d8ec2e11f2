"""How much a node trusts itself on the bus: error counters and the states that follow from them.

ISO 11898-1, fault confinement: a node that keeps making errors first stops disturbing others (error
passive), then leaves the bus (bus-off).
"""

from __future__ import annotations

ACTIVE, PASSIVE, BUS_OFF, NO_POWER = "error active", "error passive", "bus-off", "without power"

_WARY = 127  # either counter above: error passive
_MOST = 255  # transmit errors above: bus-off
_RELAXED = 119  # a receiver that was error passive comes back to here


class ErrorState:
    """Transmit and receive error counter (`tec`, `rec`) of one node.

    absent: BUS_OFF or NO_POWER where it takes no part in the bus, else empty.
    """

    __slots__ = ("absent", "rec", "tec")

    def __init__(self) -> None:
        self.tec = 0
        self.rec = 0
        self.absent = ""

    @property
    def state(self) -> str:
        """ACTIVE, PASSIVE, BUS_OFF or NO_POWER."""
        return self.absent or (PASSIVE if self.passive else ACTIVE)

    @property
    def passive(self) -> bool:
        """Its error flags are recessive: nobody notices them."""
        return self.tec > _WARY or self.rec > _WARY

    @property
    def spotless(self) -> bool:
        """Nothing has gone wrong, or all of it is made up for."""
        return not (self.tec or self.rec or self.absent)

    def sent(self) -> None:
        """A frame of the node has got through."""
        if self.tec:
            self.tec -= 1

    def received(self) -> None:
        """A frame of another node has come in without an error."""
        if self.rec:
            self.rec = _RELAXED if self.rec > _WARY else self.rec - 1

    def failed_to_send(self, unanswered: bool = False) -> None:
        """A frame of the node has failed; unanswered: for want of an acknowledgement only.

        A node that is alone counts up to error passive and no further, so it never leaves the bus for that.
        """
        if not (unanswered and self.passive):
            self.tec += 8
        if self.tec > _MOST:
            self.absent = BUS_OFF

    def failed_to_receive(self, first: bool = False) -> None:
        """The node took part in an error frame; first: it saw the error before the others did."""
        self.rec = min(self.rec + (9 if first else 1), _MOST)

    def restart(self) -> None:
        """Takes part again as if nothing had been."""
        self.tec = self.rec = 0
        self.absent = ""
