from __future__ import annotations

import struct

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from hilbed.record.columns import Columns
from hilbed.record.hashing import BusDigest, run_hash, signals_hash
from hilbed.record.row import Batch
from hilbed.types import Frame, Transfer
from tests.record.runs import play


def fingerprints(cycles: int = 301, boot: int = 3) -> tuple[str, str]:
    columns, digest = Columns(("left", "right")), BusDigest()
    play([columns, digest], cycles, boot)
    signals = columns.finish()
    return run_hash(signals, digest.digest()), signals_hash(signals)


def test_the_same_run_has_the_same_hash_and_another_has_not() -> None:
    assert fingerprints() == fingerprints()
    assert fingerprints(cycles=300)[0] != fingerprints()[0]
    assert fingerprints(cycles=300)[1] != fingerprints()[1]


def test_frames_before_the_first_cycle_count_for_the_bus_alone() -> None:
    assert fingerprints(boot=2)[0] != fingerprints(boot=3)[0]
    assert fingerprints(boot=2)[1] == fingerprints(boot=3)[1]


@given(arrays(np.float64, st.integers(1, 5)), st.integers(0, 4))
def test_any_change_of_a_number_changes_the_hash(values: np.ndarray, place: int) -> None:
    other = values.copy()
    k = place % len(values)
    other[k] = 1.0 if np.isnan(values[k]) else np.nan
    assert signals_hash({"a": values}) == signals_hash({"a": values.copy()})
    assert signals_hash({"a": values}) != signals_hash({"a": other})


def test_order_of_names_and_bits_of_nan_do_not_count_but_shape_and_name_do() -> None:
    one, two = np.arange(4.0), np.ones(2)
    assert signals_hash({"a": one, "b": two}) == signals_hash({"b": two, "a": one})
    odd = np.frombuffer(struct.pack("<Q", 0xFFF8_0000_0000_0001))
    assert signals_hash({"a": odd}) == signals_hash({"a": np.array([np.nan])})
    assert signals_hash({"a": one}) != signals_hash({"a": one.reshape(2, 2)})
    assert signals_hash({"a": one}) != signals_hash({"c": one})


def digest_of(*transfers: Transfer) -> bytes:
    digest = BusDigest()
    digest.take(Batch((), transfers, (), (), ()))
    return digest.digest()


def test_every_part_of_a_frame_counts() -> None:
    frame = Frame(0x123, b"\x01\x02")
    same = Transfer(0, 10, 20, frame, "left")
    others = [
        same._replace(queued=1),
        same._replace(start=11),
        same._replace(end=21),
        same._replace(node="right"),
        same._replace(error=1),
        same._replace(error=2),
        *(
            same._replace(frame=other)
            for other in (
                frame._replace(id=0x124),
                frame._replace(data=b"\x01"),
                frame._replace(extended=True),
                frame._replace(remote=True),
            )
        ),
    ]
    assert len({digest_of(same), *(digest_of(other) for other in others)}) == len(others) + 1


def test_splitting_a_run_into_batches_does_not_count() -> None:
    one, two = Transfer(0, 1, 2, Frame(1), "a"), Transfer(3, 4, 5, Frame(2), "b")
    digest = BusDigest()
    for transfer in (one, two):
        digest.take(Batch((), [transfer], (), (), ()))
    assert digest.digest() == digest_of(one, two)


def test_what_tells_of_the_wall_clock_is_in_no_hash() -> None:
    signals = {"t": np.arange(3.0), "realtime/t": np.arange(3.0)}
    other = {**signals, "realtime/t": np.ones(2), "realtime/lateness": np.zeros(2)}
    assert signals_hash(signals) == signals_hash(other)
    assert run_hash(signals, b"") == run_hash(other, b"")
