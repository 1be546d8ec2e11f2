"""What a test on the bus asks drives by itself: SDO reads and the speeds in their PDOs, without hilbed."""

from __future__ import annotations

import math
import struct
import time

import can

from tests.hil.processes import VCAN, Process

COUNTS_PER_TURN = 66_000
PATIENCE = 60.0


class Probe:
    """A node on vcan0 that reads objects and listens."""

    def __init__(self) -> None:
        self.bus = can.Bus(VCAN, interface="socketcan")

    def close(self) -> None:
        self.bus.shutdown()

    def await_frame(self, identifier: int, least: float = 0.0, process: Process | None = None) -> can.Message:
        """Waits for a frame with this identifier, as long as `process` runs.

        least: rad/s that it must tell of, if it is a TPDO1.
        """
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline and (process is None or process.poll() is None):
            message = self.bus.recv(1.0)
            if message is None or message.arbitration_id != identifier or message.is_extended_id:
                continue
            if not least or pdo_speed(bytes(message.data)) >= least:
                return message
        raise AssertionError(f"no such {identifier:03X} on {VCAN} within {PATIENCE:g} s, or its sender ended")

    def read(self, node: int, index: int, sub: int = 0) -> int:
        """Reads an object of at most four bytes, as a signed number."""
        return sdo_number(self._ask(node, struct.pack("<BHB4x", 0x40, index, sub)))

    def write_u16(self, node: int, index: int, value: int) -> None:
        answer = self._ask(node, struct.pack("<BHBH2x", 0x2B, index, 0, value))
        assert answer[0] == 0x60, f"write refused: {answer.hex()}"

    def _ask(self, node: int, request: bytes) -> bytes:
        """Sends an SDO request and returns the answer to it, though others may be asking as well."""
        self.bus.send(can.Message(arbitration_id=0x600 + node, data=request, is_extended_id=False))
        while True:
            answer = bytes(self.await_frame(0x580 + node).data)
            if answer[1:4] == request[1:4]:
                return answer


def sdo_number(answer: bytes) -> int:
    """Returns the signed number of an expedited upload."""
    command = answer[0]
    assert command & 0xE3 == 0x43, f"no expedited upload: {answer.hex()}"
    return int.from_bytes(answer[4 : 8 - (command >> 2 & 3)], "little", signed=True)


def pdo_speed(data: bytes) -> float:
    """Returns rad/s of TPDO1: statusword, actual velocity (counts/s), torque."""
    return radians(struct.unpack_from("<i", data, 2)[0])


def radians(counts: float) -> float:
    return counts * 2.0 * math.pi / COUNTS_PER_TURN
