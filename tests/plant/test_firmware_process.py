"""`python -m firmware_sim`: how it ends."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from tests.plant.firmware import process
from tests.plant.hub import Hub


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_signal_is_its_end(number: signal.Signals) -> None:
    with Hub(1) as hub, process(1, "slcan", hub.paths[0]) as running:
        running.send_signal(number)
        assert running.wait(20) == 0


def test_a_bus_that_goes_away_ends_it_with_a_message() -> None:
    with Hub(1) as hub, process(3, "slcan", hub.paths[0]) as running:
        hub.unplug(0)
        assert running.wait(20) == 7
        assert running.stderr is not None
        assert "firmware node 3: the bus is lost" in running.stderr.read()


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["--node", "0"], "0 is not 1 to 127"),
        (["--node", "128"], "128 is not 1 to 127"),
        (["--node", "x"], "--node"),
        ([], "--node"),
        (["--node", "1", "-i", "slcan", "-c", "/dev/no-such-adapter"], "/dev/no-such-adapter"),
        (["--node", "1", "-i", "nothing", "-c", "x"], "nothing"),
        (["--node", "1", "-i", "virtual", "-c", "x", "-b", "fast"], "invalid int value: 'fast'"),
    ],
)
def test_what_it_refuses(options: list[str], said: str) -> None:
    command = [sys.executable, "-m", "firmware_sim", *options]
    ended = subprocess.run(command, capture_output=True, text=True, timeout=60, env=dict(os.environ))
    assert ended.returncode == 4
    assert said in ended.stderr
    assert "Traceback" not in ended.stderr
