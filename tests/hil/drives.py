"""What a test on the bus asks drives by itself: SDO reads and the speeds in their PDOs, without hilbed."""

from __future__ import annotations

import math
import struct

import can

from tests.hil.processes import VCAN

COUNTS_PER_TURN = 66_000
PATIENCE = 10.0


class Tester:
    """A node on vcan0 that reads objects and listens."""

    def __init__(self) -> None:
        self.bus = can.Bus(VCAN, interface="socketcan")

    def close(self) -> None:
        self.bus.shutdown()

    def await_frame(self, identifier: int) -> can.Message:
        """Waits for the next frame with this identifier."""
        while True:
            message = self.bus.recv(PATIENCE)
            assert message is not None, f"silence on {VCAN} while waiting for {identifier:03X}"
            if message.arbitration_id == identifier and not message.is_extended_id:
                return message

    def await_speed(self, node: int, least: float) -> None:
        """Waits until TPDO1 of a drive tells of at least this speed (rad/s)."""
        while pdo_speed(bytes(self.await_frame(0x180 + node).data)) < least:
            pass

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
