"""scripts/vcan: how it is used, what it says where there can be no bus, and that it is transparent."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "scripts" / "vcan"
WRONG_USAGE, IMPOSSIBLE, OUT_OF_TIME = 64, 77, 124
TOOLS = ("bash", "env", "readlink", "dirname", "id", "mktemp", "sed", "paste", "cat", "rm", "sleep")

pytestmark = pytest.mark.skipif(os.name != "posix", reason="a script for Linux")


def vcan(*arguments: str, **more: str) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, **more}
    return subprocess.run(
        [SCRIPT, *arguments], env=environment, capture_output=True, text=True, timeout=120, check=False
    )


@pytest.fixture(scope="module")
def _bus() -> None:
    """Skips where neither kernel has a bus for us; apt-get is not asked for one."""
    if shutil.which("linux.uml") is None or vcan("true").returncode == IMPOSSIBLE:
        pytest.skip("no vcan0 is possible here")


@pytest.mark.parametrize("arguments", [(), ("--timeout", "soon", "true"), ("--unknown", "true")])
def test_wrong_usage_is_told(arguments: tuple[str, ...]) -> None:
    ended = vcan(*arguments)
    assert ended.returncode == WRONG_USAGE
    assert "Usage: scripts/vcan [--timeout SECONDS] COMMAND" in ended.stderr


def test_where_no_bus_is_possible_the_reason_is_told(tmp_path: Path) -> None:
    for tool in TOOLS:
        (tmp_path / tool).symlink_to(shutil.which(tool) or tool)
    for tool in ("ip", "unshare"):
        (tmp_path / tool).write_text("#!/bin/sh\necho not permitted >&2\nexit 1\n")
        (tmp_path / tool).chmod(0o755)
    ended = vcan("echo", "never", PATH=str(tmp_path))
    assert ended.returncode == IMPOSSIBLE
    assert ended.stdout == ""
    assert "no vcan0: the host's kernel: not permitted; a user-mode kernel: no linux.uml" in ended.stderr
    assert "apt-get install user-mode-linux" in ended.stderr


@pytest.mark.usefixtures("_bus")
def test_output_status_and_arguments_are_the_commands() -> None:
    words = ["two words", 'a "quote"', "", "$HOME *", "line\nbreak"]
    say = 'printf "%s|" "$@"; echo "$COLOUR" >&2; ip -o link show up dev vcan0 | wc -l; exit 9'
    ended = vcan("sh", "-c", say, "sh", *words, COLOUR="dark blue")
    assert ended.stdout == "".join(f"{word}|" for word in words) + "1\n"
    assert ended.stderr == "dark blue\n"
    assert ended.returncode == 9


@pytest.mark.usefixtures("_bus")
def test_out_of_time() -> None:
    ended = vcan("--timeout", "0.5", "sleep", "1000")
    assert ended.returncode == OUT_OF_TIME
    assert ended.stderr == "hilbed: out of time after 0.5 s: sleep 1000\n"
