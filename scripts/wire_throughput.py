"""Prints how many frames a second the wire carries, beside python-can's virtual bus.

`python scripts/wire_throughput.py`. One node sends, each of the others takes every frame as it comes. Side by
side in one run, in turns, the best of several: the ratio is the number, as machines are noisy. "wire" is what
a bench uses (Port.send, Wire.advance, Port.recv); "plugin" is the same python-can program as on "virtual", on
interface hilbed. Both compute the exact length of every frame, stuff bits and CRC included, and arbitrate.
"""

from __future__ import annotations

import gc
import random
from collections.abc import Callable
from time import perf_counter

import can

from hilbed.can.wire import Wire
from hilbed.types import Frame

FRAMES, ROUNDS = 6_000, 5
WANTED = {1: 1.0, 3: 2.0, 7: 3.0}  # times python-can's virtual bus
IDENTIFIERS = (0x080, 0x181, 0x182, 0x201, 0x202, 0x281, 0x282, 0x701)

random.seed(1)
frames = [Frame(random.choice(IDENTIFIERS), random.randbytes(random.choice((0, 6, 8)))) for _ in range(500)]


def wire(receivers: int) -> float:
    """Returns frames a second of the wire itself."""
    medium = Wire(500_000)
    sender, *ports = (medium.attach(str(k)) for k in range(receivers + 1))
    medium.advance(0)
    begun, t = perf_counter(), 0
    for k in range(FRAMES):
        sender.send(t, frames[k % 500])
        t += 300_000
        medium.advance(t)
        for port in ports:
            port.recv(t)
    return FRAMES / (perf_counter() - begun)


def python_can(interface: str) -> Callable[[int], float]:
    """Returns what measures frames a second of python-can buses of an interface."""

    def measure(receivers: int) -> float:
        sender, *others = buses = [can.Bus(interface=interface, channel="t") for _ in range(receivers + 1)]
        sent = [can.Message(arbitration_id=one.id, data=one.data, is_extended_id=False) for one in frames]
        begun = perf_counter()
        for k in range(FRAMES):
            sender.send(sent[k % 500])
            for bus in others:
                bus.recv(1.0)
        rate = FRAMES / (perf_counter() - begun)
        for bus in buses:
            bus.shutdown()
        return rate

    return measure


gc.disable()
print("receivers   virtual        wire                plugin              wanted    (frames/s)")
for receivers, times in WANTED.items():
    ways = {"virtual": python_can("virtual"), "wire": wire, "plugin": python_can("hilbed")}
    best = dict.fromkeys(ways, 0.0)
    for _ in range(ROUNDS):
        for name, measure in ways.items():
            best[name] = max(best[name], measure(receivers))
    base = best.pop("virtual")
    shown = "".join(f"{rate:10,.0f} ({rate / base:4.1f} x)" for rate in best.values())
    print(f"{receivers:9d}{base:10,.0f}   {shown}    {times:4.1f} x")
