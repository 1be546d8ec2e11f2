"""Two drives with one node number: how a bus shows them while they are booted."""

from __future__ import annotations

from collections import Counter

from hilbed.can.cob import SDO_ANSWER
from hilbed.can.nmt import HeartbeatConsumer
from hilbed.can.node import Node
from hilbed.types import BusError, Received


class Twins:
    """Counts what each number answers: two drives answer twice as often as they are asked."""

    def __init__(self, heard: HeartbeatConsumer) -> None:
        self._heard = heard
        self._boots: dict[int, int] = {}
        self._answers: Counter[int] = Counter()

    def hear(self, received: Received) -> None:
        """Takes any frame; heeds SDO answers."""
        identifier, _, extended, remote = received.frame
        if not extended and not remote and SDO_ANSWER < identifier <= SDO_ANSWER + 127:
            self._answers[identifier - SDO_ANSWER] += 1

    def watch(self, node: Node) -> None:
        """Begins to count for a node that has answered after its reset.

        Not before: a drive that has just been powered starts twice, by its supply and by the reset.
        """
        self._boots[node.id] = self._heard.boots.get(node.id, 0)
        self._answers[node.id] = 0

    def check(self, node: Node, asked: int) -> None:
        """Raises BusError where more has come than the answers to what the node was asked."""
        answers = self._answers[node.id]
        if answers > asked:
            raise BusError(
                f"{node}: {answers} answers to {asked} SDO requests: two drives have the number {node.id}"
            )
        if self._heard.boots.get(node.id, 0) > self._boots[node.id]:
            raise BusError(
                f"{node}: started anew while it was configured: does its supply fail, or have two drives the "
                f"number {node.id}?"
            )
