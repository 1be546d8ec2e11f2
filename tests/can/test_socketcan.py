"""What is found out about a SocketCAN interface beforehand, with the system's answers made up."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

from hilbed.can import socketcan
from hilbed.can.driver import open_driver
from hilbed.types import ScenarioError


@pytest.fixture
def system(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """Returns how to set the flags of can0 and what `ip` prints, an exception being raised."""

    def answer(flags: str, shown: object) -> None:
        (tmp_path / "sys/class/net/can0").mkdir(parents=True)
        (tmp_path / "sys/class/net/can0/flags").write_text(flags)

        def run(command: list[str], **_: object) -> subprocess.CompletedProcess[bytes]:
            assert command[-1] == "can0"
            if isinstance(shown, Exception):
                raise shown
            return subprocess.CompletedProcess(command, 0, stdout=str(shown).encode())

        monkeypatch.setattr(socketcan, "Path", lambda path: tmp_path / str(path).lstrip("/"))
        monkeypatch.setattr(subprocess, "run", run)

    return answer


def shown(bitrate: int) -> str:
    return json.dumps([{"linkinfo": {"info_kind": "can", "info_data": {"bittiming": {"bitrate": bitrate}}}}])


def test_an_interface_that_is_down_is_refused_with_what_brings_it_up(system: Any) -> None:
    system("0x80", "")
    assert socketcan.complaint("can0", 500_000) == "is down; `ip link set can0 up` brings it up"
    with pytest.raises(ScenarioError, match="bus: socketcan can0 is down"):
        open_driver("socketcan", "can0", 500_000)


def test_another_bit_rate_is_refused(system: Any) -> None:
    system("0x81", shown(250_000))
    assert "runs at 250000 bit/s, not at 500000; give -b 250000" in socketcan.complaint("can0", 500_000)
    assert socketcan.complaint("can0", 250_000) == ""
    assert socketcan.complaint("can0", None) == ""


@pytest.mark.parametrize(
    "answer",
    [
        FileNotFoundError("ip"),
        subprocess.CalledProcessError(1, "ip"),
        subprocess.TimeoutExpired("ip", 5.0),
        "",
        "[]",
        "[{}]",
        json.dumps([{"linkinfo": {"info_kind": "vcan"}}]),
        json.dumps([{"linkinfo": None}]),
    ],
)
def test_what_nobody_knows_is_no_reason_to_refuse(system: Any, answer: object) -> None:
    system("0x81", answer)
    assert socketcan.complaint("can0", 500_000) == ""


def test_an_interface_that_is_not_there_is_left_to_the_socket() -> None:
    assert socketcan.complaint("nocan7", 500_000) == ""
