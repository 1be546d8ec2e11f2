"""python-can's own tools on the interface "hilbed", all in one process: they find a bus like any other."""

from __future__ import annotations

import queue
import threading
import time
from pathlib import Path
from typing import Any

import can
import pytest

from hilbed.can import channels
from hilbed.can.wire import Wire
from hilbed.types import Frame

PATIENCE = 20.0  # s, for what takes a millisecond; only a failure waits so long


def bus(channel: str = "bench", **options: Any) -> can.BusABC:
    return can.Bus(interface="hilbed", channel=channel, **options)


def message(identifier: int, data: bytes = b"", **options: Any) -> can.Message:
    return can.Message(arbitration_id=identifier, data=data, is_extended_id=False, **options)


def state(of: can.BusABC) -> str:
    return of.state.name


def listening(bus: can.BusABC, *more: Any) -> tuple[can.Notifier, queue.Queue[can.Message]]:
    heard: queue.Queue[can.Message] = queue.Queue()
    return can.Notifier(bus, [heard.put, *more], timeout=0.05), heard


def test_a_notifier_hears_what_the_main_thread_sends() -> None:
    with bus() as a, bus() as b:
        notifier, heard = listening(b)
        for k in range(50):
            a.send(message(0x100 + k, bytes([k])))
        found = [heard.get(timeout=PATIENCE) for _ in range(50)]
        notifier.stop()
    assert [one.arbitration_id for one in found] == [0x100 + k for k in range(50)]
    stamps = [one.timestamp for one in found]
    assert stamps == sorted(stamps)


def test_a_listener_answers_a_request_while_the_main_thread_waits_in_recv() -> None:
    """The wait is in real time, else a second would be over before the other thread gets to answer."""
    with bus() as client, bus() as server:
        notifier, _ = listening(server, lambda asked: server.send(message(asked.arbitration_id + 1)))
        for k in range(0, 20, 2):
            client.send(message(0x200 + k))
            answer = client.recv(PATIENCE)
            assert answer is not None
            assert answer.arbitration_id == 0x201 + k
        notifier.stop()


def test_a_notifier_without_traffic_does_not_race_through_time() -> None:
    """Its recv(timeout) waits in real time: simulated time goes on no faster than the wall clock."""
    with bus() as a, bus() as b:
        begun = time.monotonic()
        notifier, heard = listening(b)
        a.send(message(1))
        first = heard.get(timeout=PATIENCE)
        for _ in range(5):
            assert a.recv(0.01) is None
        a.send(message(2))
        last = heard.get(timeout=PATIENCE)
        notifier.stop()
        assert 0.05 < last.timestamp - first.timestamp <= time.monotonic() - begun


def test_after_a_notifier_has_stopped_time_is_simulated_again() -> None:
    with bus() as a, bus() as b:
        notifier, heard = listening(b)
        a.send(message(1))
        heard.get(timeout=PATIENCE)
        notifier.stop()
        begun = time.monotonic()
        assert b.recv(10 * PATIENCE) is None
        a.send(message(2))
        found = b.recv(1.0)
        assert found is not None
        assert found.timestamp > 10 * PATIENCE > time.monotonic() - begun


def test_two_notifiers_on_two_channels_do_not_meet() -> None:
    with bus("one") as a, bus("one") as b, bus("two") as c, bus("two") as d:
        (first, of_b), (second, of_d) = listening(b), listening(d)
        a.send(message(0x11))
        c.send(message(0x22))
        assert of_b.get(timeout=PATIENCE).arbitration_id == 0x11
        assert of_d.get(timeout=PATIENCE).arbitration_id == 0x22
        first.stop()
        second.stop()
        assert of_b.empty()
        assert of_d.empty()


@pytest.mark.parametrize("suffix", [".asc", ".blf", ".csv", ".log", ".trc"])
def test_a_logger_writes_what_a_log_reader_gives_back(tmp_path: Path, suffix: str) -> None:
    sent = [message(0x101, b"abc"), can.Message(arbitration_id=0x1ABCDEF0, data=b"12345678"), message(0x7FF)]
    path = tmp_path / f"log{suffix}"
    with bus() as a, bus() as b:
        logger = can.Logger(path)
        notifier, heard = listening(b, logger)
        for one in sent:
            a.send(one)
            heard.get(timeout=PATIENCE)
        notifier.stop()
    read = list(can.LogReader(path))
    assert len(read) == len(sent)
    for one, other in zip(sent, read, strict=True):
        assert one.equals(other, timestamp_delta=None, check_channel=False, check_direction=False)


def test_a_log_is_played_back_with_message_sync(tmp_path: Path) -> None:
    path = tmp_path / "log.log"
    with can.CanutilsLogWriter(path) as writer:
        for k in range(5):
            writer.on_message_received(message(0x300 + k, timestamp=100.0 + 0.01 * k))
    with bus() as a, bus() as b:
        notifier, heard = listening(b)
        for one in can.MessageSync(can.LogReader(path), timestamps=True, gap=0.0001):
            a.send(one)
        found = [heard.get(timeout=PATIENCE) for _ in range(5)]
        notifier.stop()
    assert [one.arbitration_id for one in found] == [0x300 + k for k in range(5)]
    assert found[-1].timestamp - found[0].timestamp > 0.01, "the gaps of the log"


def test_message_sync_without_timestamps_in_one_thread() -> None:
    with bus() as a, bus() as b:
        for one in can.MessageSync(
            [message(k, timestamp=1e3 * k) for k in range(1, 4)], timestamps=False, gap=0
        ):
            a.send(one)
        assert [found.arbitration_id for found in b] == [1, 2, 3]


def test_periodic_messages_are_exact_in_simulated_time() -> None:
    with bus() as a, bus() as b:
        task = a.send_periodic([message(0x10, b"\1"), message(0x10, b"\2")], 0.01, duration=0.1)
        found = list(b)
        assert isinstance(task, can.CyclicSendTaskABC)
    gaps = [later.timestamp - one.timestamp for one, later in zip(found[::2], found[2::2], strict=False)]
    assert len(found) == 10
    assert gaps == pytest.approx([0.02] * 4, abs=1e-9)
    assert [one.data[0] for one in found] == [1, 2] * 5


def test_a_periodic_message_can_be_modified_stopped_and_started_again() -> None:
    with bus() as a, bus() as b:
        count = 0

        def numbered(one: can.Message) -> None:
            nonlocal count
            count += 1
            one.data[0] = count

        task = a.send_periodic(message(0x10, b"\0"), 0.01)
        counted = a.send_periodic(message(0x20, b"\0"), 0.01, modifier_callback=numbered)
        received = [b.recv(1.0) for _ in range(6)]
        assert [one.data[0] for one in received if one and one.arbitration_id == 0x20] == [1, 2, 3]
        counted.stop()
        assert isinstance(task, can.ModifiableCyclicTaskABC)
        assert isinstance(task, can.RestartableCyclicTaskABC)
        task.modify_data(message(0x10, b"\x09"))
        one = b.recv(1.0)
        assert one is not None
        assert (one.arbitration_id, bytes(one.data)) == (0x10, b"\x09"), "the very next one"
        task.stop()
        assert b.recv(10.0) is None
        task.start()
        assert b.recv(1.0) is not None
        a.shutdown()
        assert b.recv() is None, "a task ends with its bus"


def test_a_bus_hears_itself_if_it_wants_to() -> None:
    with bus(receive_own_messages=True) as a, bus() as b:
        a.send(message(5, b"x"))
        b.send(message(6))
        found = [a.recv(1.0), a.recv(1.0)]
        assert [(one.arbitration_id, one.is_rx) for one in found if one] == [(5, False), (6, True)]


def test_what_is_queued_can_be_flushed() -> None:
    with bus() as a, bus() as b:
        for k in range(10):
            a.send(message(k))
        assert b.recv(0.00009) is None
        a.flush_tx_buffer()
        assert [one.arbitration_id for one in b] == [0], "what is on the wire stays there"


def test_a_lone_node_becomes_passive_waits_and_is_heard_by_the_next_one() -> None:
    """Nobody acknowledges: error passive, but never bus-off; and waiting for a day costs no time."""
    with bus() as a:
        assert state(a) == "ACTIVE"
        a.send(message(0x123))
        assert a.recv() is None
        assert a.recv(86_400.0) is None
        assert state(a) == "PASSIVE"
        with bus() as b:
            one = b.recv(1.0)
            assert one is not None
            assert one.arbitration_id == 0x123
            assert one.timestamp > 86_400
            for k in range(200):
                a.send(message(k))
            assert len(list(b)) == 200
            assert state(a) == "ACTIVE"


def test_two_nodes_with_one_identifier_collide_and_error_frames_show_it() -> None:
    with bus() as a, bus() as b, bus(error_frames=True) as c:
        a.send(message(0x55, b"one"))
        b.send(message(0x55, b"two"))
        found = list(c)
        errors = [one for one in found if one.is_error_frame]
        assert len(errors) == 16, "each costs 8; above 127 the flag of the one that is overruled is unheard"
        assert [bytes(one.data) for one in found if not one.is_error_frame] == [b"one", b"two"]
        assert (a.state, b.state) == (can.BusState.ACTIVE, can.BusState.PASSIVE)


def test_a_node_that_is_off_the_bus_refuses_until_it_has_recovered() -> None:
    wire = Wire(500_000)
    wire.advance(0)
    with channels.lend("bench", wire), bus(auto_restart=False) as a:
        wire.port("bench-1").fail(wire.now)
        assert state(a) == "ERROR"
        with pytest.raises(can.CanOperationError, match="bus-off"):
            a.send(message(1))
        wire.advance(10**9)
        assert state(a) == "ERROR"
        a.state = can.BusState.ACTIVE
        wire.advance(wire.now + 128 * 11 * 2000 - 1)
        assert state(a) == "ERROR"
        wire.advance(wire.now + 1)
        assert state(a) == "ACTIVE"
        with pytest.raises(NotImplementedError):
            a.state = can.BusState.PASSIVE


def test_another_thread_on_a_channel_that_a_bench_has_lent() -> None:
    """A Notifier hears what the bench moves, and sends into it; neither touches the other's time."""
    wire = Wire(500_000)
    wire.advance(0)
    node = wire.attach("node")
    with channels.lend("bench", wire), bus() as guest:
        notifier, heard = listening(guest, lambda one: guest.send(message(one.arbitration_id + 1)))
        for k in range(0, 40, 2):
            node.send(wire.now, Frame(0x100 + k))
            wire.advance(wire.now + 10**6)
            assert heard.get(timeout=PATIENCE).arbitration_id == 0x100 + k
        answers: list[int] = []
        while len(answers) < 20:
            wire.advance(wire.now + 10**6)
            answers += [received.frame.id for received in node.recv(wire.now)]
        notifier.stop()
    assert answers == [0x101 + k for k in range(0, 40, 2)]


def test_many_threads_lose_and_double_nothing() -> None:
    with bus() as hub:
        notifier, heard = listening(hub)
        ready = threading.Barrier(4)

        def chatter(who: int) -> None:
            with bus() as own:
                ready.wait()
                for k in range(50):
                    own.send(message(0x100 * who + k, bytes([who, k])))
                while own.recv(0.2) is not None:
                    pass

        threads = [threading.Thread(target=chatter, args=(who,)) for who in range(1, 5)]
        for thread in threads:
            thread.start()
        found = sorted(heard.get(timeout=PATIENCE).arbitration_id for _ in range(200))
        for thread in threads:
            thread.join(PATIENCE)
        notifier.stop()
        assert heard.empty()
    assert found == sorted(0x100 * who + k for who in range(1, 5) for k in range(50))
    assert channels.names() == []
