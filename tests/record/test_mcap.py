from __future__ import annotations

import os
import signal
import struct
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader

from hilbed.record.disk import RecordError
from hilbed.record.mcap import McapLog, Setting, events
from hilbed.record.row import Batch
from hilbed.scene import BeaconSpec
from hilbed.types import Nanos
from tests.record.runs import FIELDS, image, play

BOOT: Nanos = 2_000_000_000


class Bump:
    kind, start, length = "load_torque", 1.0, 0.5


class ForGood:
    kind, start, length = "wheel_radius", 2.0, None


SETTING = Setting(
    beacons=[BeaconSpec(at=(1.0, 2.0), colour="blue")],
    path=[(0.0, 0.0), (3.0, 0.0)],
    events=events([Bump()]),
    scenario="seed: 1\n",
)


def recorded(path: Path, cycles: int = 301) -> dict[str, list[tuple[int, bytes]]]:
    play([McapLog(path, BOOT, SETTING)], cycles)
    topics: dict[str, list[tuple[int, bytes]]] = {}
    with path.open("rb") as stream:
        for _, channel, message in make_reader(stream, validate_crcs=True).iter_messages():
            topics.setdefault(channel.topic, []).append((message.log_time, message.data))
    return topics


def numbers(data: bytes) -> tuple[float, ...]:
    """Reads a CDR message that holds nothing but float64."""
    assert data[:4] == b"\x00\x01\x00\x00"
    return struct.unpack(f"<{(len(data) - 4) // 8}d", data[4:])


def test_every_topic_is_there_with_its_messages_at_their_times(tmp_path: Path) -> None:
    topics = recorded(tmp_path / "log.mcap")
    counts = {topic: len(messages) for topic, messages in topics.items() if "/pose/" not in topic}
    assert counts == {
        "/scene": 1, "/events": 2, "/cycle": 301, "/drives": 301, "/ticks": 3000, "/tf": 301,
        "/can": 605, "/nis": 31, "/reading/azimuth": 31, "/camera/image": 31, "/camera/detections": 31,
    }  # fmt: skip
    for name in ("truth", "estimate", "odometry", "reference"):
        assert 60 <= len(topics[f"/pose/{name}"]) <= 66, "every fifth cycle, and the first of a batch"
    assert [t for t, _ in topics["/cycle"]] == [BOOT + k * 10_000_000 for k in range(301)]
    assert [t for t, _ in topics["/ticks"]] == [BOOT + k * 1_000_000 for k in range(3000)]
    assert [t for t, _ in topics["/events"]] == [BOOT + 1_000_000_000, BOOT + 1_500_000_000]


def test_numbers_can_be_read_by_their_definitions(tmp_path: Path) -> None:
    topics = recorded(tmp_path / "log.mcap", 21)
    cycle = numbers(topics["/cycle"][20][1])
    assert cycle[:6] == pytest.approx((0.2, 2.0, 0.0, 0.2, 0.2, 0.3))
    assert cycle[12:15] == pytest.approx((0.0, -1.8, 0.3))
    assert cycle[15:18] == pytest.approx(np.sqrt([1.1, 4.1, 9.1]))
    assert cycle[18:20] == pytest.approx((0.5, -0.1))
    assert cycle[20:] == pytest.approx((np.diag([1.0, 4.0, 9.0]) + 0.1).ravel())
    assert numbers(topics["/drives"][10][1]) == pytest.approx((5.0, 14.9, 5.0) * 2)
    assert numbers(topics["/reading/azimuth"][1][1]) == pytest.approx((0.1, 0.13, 0.0, 0.5, 0.49))
    assert numbers(topics["/nis"][0][1]) == (1.5, 1.0, 1.0)


def test_ticks_are_grouped_by_drive_in_the_order_of_their_definition(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    topics = recorded(path, 101)
    with path.open("rb") as stream:
        schemas = make_reader(stream).get_summary().schemas.values()  # type: ignore[union-attr]
    text = next(schema.data.decode() for schema in schemas if schema.name == "hilbed_msgs/msg/Tick")
    assert text.startswith("hilbed_msgs/Tick_left left\nhilbed_msgs/Tick_right right\n====")
    fields = [line.split()[1] for line in text.splitlines() if line.startswith("float64")]
    row = dict(zip(fields[:7], numbers(topics["/ticks"][5][1])[:7], strict=True))
    assert row == pytest.approx({field: number + 0.005 for number, field in enumerate(FIELDS)})


def test_poses_and_frames_have_the_layout_of_ros(tmp_path: Path) -> None:
    topics = recorded(tmp_path / "log.mcap", 21)
    stamp, data = topics["/pose/estimate"][4]
    assert struct.unpack("<iI I4s 7d", data[4:]) == pytest.approx(
        (2, 200_000_000, 4, b"map\0", 0.2, 0.2, 0.0, 0.0, 0.0, np.sin(0.15), np.cos(0.15))
    )
    count, *head = struct.unpack("<I iI I4s I10s", topics["/tf"][20][1][4:38])
    assert (count, *head) == (1, 2, 200_000_000, 4, b"map\0", 10, b"base_link\0")
    assert struct.unpack("<7d", topics["/tf"][20][1][44:])[0] == pytest.approx(0.2)
    stamp, data = topics["/can"][0]
    assert stamp == 1_000_234_000
    assert struct.unpack("<ddd I??BB8s I", data[4:48]) == pytest.approx(
        (234e-6, 10e-6, 0.0, 0x700, False, False, 2, 0, b"\x01\xab\0\0\0\0\0\0", 5)
    )
    assert data[48:] == b"left\0"


def test_images_are_kept_to_the_bit(tmp_path: Path) -> None:
    for k, (_, data) in enumerate(recorded(tmp_path / "log.mcap", 21)["/camera/image"]):
        assert image(10 * k).tobytes() in data


def test_the_same_run_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("one", "two"):
        recorded(tmp_path / name, 150)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


def test_events_are_in_order_of_time() -> None:
    assert events([Bump()]) == [
        (1_000_000_000, "load_torque begins"),
        (1_500_000_000, "load_torque ends"),
    ]
    assert events([ForGood()]) == [(2_000_000_000, "wheel_radius begins")]


def test_a_full_disk_ends_the_run_with_a_word(capfd: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(RecordError, match="No space left"):
        play([McapLog(Path("/dev/full"), BOOT)])
    assert capfd.readouterr().err == ""


def readable(path: Path) -> list[int]:
    """Log times of a file that has not been finished, as any reader finds them."""
    with path.open("rb") as stream:
        return [message.log_time for _, _, message in make_reader(stream).iter_messages(topics="/cycle")]


def test_the_file_is_a_whole_one_all_the_time(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    log = McapLog(path, BOOT)
    seen: list[int] = []

    class Looker:
        def take(self, batch: Batch) -> None:  # noqa: ARG002
            seen.append(len(readable(path)))

        def close(self) -> None:
            seen.append(len(readable(path)))

    play([log, Looker()], 351)
    assert seen == sorted(seen)
    assert len(seen) > 5
    assert seen[0] > 0
    assert seen[-1] == 351


def test_a_killed_process_leaves_a_log_up_to_the_last_second(tmp_path: Path) -> None:
    path = tmp_path / "log.mcap"
    program = (
        "import sys, time; from pathlib import Path; from hilbed.record.mcap import McapLog\n"
        "from tests.record.runs import play\n"
        "journal = play([McapLog(Path(sys.argv[1]), 2_000_000_000)], 351, close=False)\n"
        "print('ready', flush=True); time.sleep(60)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", program, str(path)], stdout=subprocess.PIPE)
    assert process.stdout is not None
    assert process.stdout.readline() == b"ready\n"
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    process.stdout.close()
    times = readable(path)
    assert times == [BOOT + k * 10_000_000 for k in range(len(times))]
    assert times[-1] >= BOOT + 2_500_000_000
