"""Which bus a run is on: command line before scenario before CAN_INTERFACE before python-can's files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from hilbed.busnames import Asked, bus_settings
from hilbed.can.specs import BusSpec
from hilbed.types import ScenarioError

FILE = "[default]\ninterface = virtual\nchannel = filed\nbitrate = 250000\n"
FILED = ['bus.interface="virtual"', 'bus.channel="filed"', "bus.bitrate=250000"]
NAMES = {"CAN_INTERFACE": "virtual", "CAN_CHANNEL": "given"}
NAMED = ['bus.interface="virtual"', 'bus.channel="given"', "bus.bitrate=250000"]


@pytest.fixture(autouse=True)
def home(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    monkeypatch.setenv("HOME", str(tmp_path))
    for name in ("CAN_INTERFACE", "CAN_CHANNEL", "CAN_BITRATE", "CAN_CONFIG"):
        monkeypatch.delenv(name, raising=False)
    (tmp_path / ".canrc").write_text(FILE)
    return tmp_path


@pytest.mark.parametrize(
    ("asked", "block", "variables", "settings"),
    [
        (Asked(), {}, {}, []),
        (Asked(bitrate=125_000), {}, {}, ["bus.bitrate=125000"]),
        (Asked("virtual"), {}, {}, FILED),
        (Asked("virtual"), {"channel": "guests"}, {}, FILED),
        (Asked(channel="named"), {}, {}, [FILED[0], "bus.channel=\"named\"", FILED[2]]),
        (Asked("virtual", bitrate=1_000_000), {}, {}, [*FILED[:2], "bus.bitrate=1000000"]),
        (Asked("slcan", "/dev/ttyACM0"), {}, NAMES, [
            "bus.interface=\"slcan\"", "bus.channel=\"/dev/ttyACM0\"", FILED[2],
        ]),
        (Asked(), {}, NAMES, NAMED),
        (Asked(), {"channel": "guests"}, NAMES, NAMED),
        (Asked(), {"interface": None}, NAMES, []),
        (Asked(), {"interface": "hilbed", "channel": "guests"}, NAMES, []),
        (Asked("hilbed", "guests"), {}, NAMES, ["bus.interface=\"hilbed\"", "bus.channel=\"guests\""]),
        (Asked(), {"interface": "socketcan", "channel": "can1"}, NAMES, [
            "bus.interface=\"socketcan\"", "bus.channel=\"can1\"", FILED[2],
        ]),
        (Asked(channel="can2"), {"interface": "socketcan", "channel": "can1", "bitrate": 1_000_000}, {}, [
            "bus.interface=\"socketcan\"", "bus.channel=\"can2\"", "bus.bitrate=1000000",
        ]),
        (Asked("virtual"), {"interface": "socketcan", "channel": "can1"}, {}, FILED),
    ],
)  # fmt: skip
def test_who_is_heeded(
    asked: Asked,
    block: dict[str, Any],
    variables: dict[str, str],
    settings: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    assert bus_settings(asked, BusSpec.model_validate(block)) == settings


def test_without_any_file_there_is_no_bit_rate_to_add(home: Path) -> None:
    (home / ".canrc").unlink()
    assert bus_settings(Asked("virtual", "x"), BusSpec()) == [*FILED[:1], 'bus.channel="x"']


def test_a_channel_alone_needs_an_interface_from_somewhere(home: Path) -> None:
    (home / ".canrc").unlink()
    with pytest.raises(ScenarioError, match="no interface that python-can knows is named"):
        bus_settings(Asked(channel="vcan0"), BusSpec())


def test_an_interface_that_nobody_knows() -> None:
    with pytest.raises(ScenarioError, match="unknown interface 'sockectan'"):
        bus_settings(Asked(), BusSpec(interface="sockectan"))
