"""Tests on a real SocketCAN bus: `scripts/vcan .venv/bin/python -m pytest tests/hil`."""

from __future__ import annotations

import shutil
import socket
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.hil.processes import VCAN
from tests.hil.witness import Candump


@pytest.hookimpl(tryfirst=True)  # before pytest looks who has which mark
def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Marks everything in this folder."""
    for item in items:
        if Path(__file__).parent in item.path.parents:
            item.add_marker(pytest.mark.hil)


@pytest.fixture(scope="session", autouse=True)
def vcan0() -> None:
    """Skips where there is no bus."""
    try:
        with socket.socket(socket.PF_CAN, socket.SOCK_RAW, socket.CAN_RAW) as bus:
            bus.bind((VCAN,))
    except (AttributeError, OSError) as error:
        pytest.skip(f"no vcan0 here ({error}); scripts/vcan runs a command where there is one")


@pytest.fixture
def candump(tmp_path: Path) -> Iterator[Candump]:
    """An independent program that writes down what is on the bus; it listens already."""
    if shutil.which("candump") is None:
        pytest.skip("no candump here; on Debian, as root: apt-get install can-utils")
    with Candump(tmp_path / "candump.log") as witness:
        yield witness
