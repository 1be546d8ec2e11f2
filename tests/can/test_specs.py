"""Scenario blocks of the bus and its nodes, and the tables behind them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from pydantic import ValidationError

from hilbed.can.drive_table import TABLES, load_table, read_table
from hilbed.can.specs import BIT_RATES, BusSpec, NodeSpec, resolve
from hilbed.can.wire import Wire
from hilbed.types import ScenarioError


def test_defaults() -> None:
    left, right = resolve({}, ("left", "right"))
    assert [(n.name, n.id, n.table.name, n.mode) for n in (left, right)] == [
        ("left", 1, "hilbed402", "csv"),
        ("right", 2, "hilbed402", "csv"),
    ]
    assert left.counts_per_turn == 66_000
    assert dict(left.settings) == {"loop": "variable_structure"}


def test_order_is_that_of_the_robot() -> None:
    nodes = resolve({"right": NodeSpec(id=3), "left": NodeSpec(id=7)}, ("left", "right"))
    assert [(node.name, node.id) for node in nodes] == [("left", 7), ("right", 3)]


def test_another_encoder_changes_all_units() -> None:
    (node,) = resolve({"left": NodeSpec(counts_per_turn=16_500)}, ["left"])
    assert node.counts_per_turn == 16_500
    assert node.counts_per_radian == pytest.approx(16_500 / (2 * 3.141592653589793))
    assert node.velocity_per_radian == node.counts_per_radian


def test_a_geared_mirrored_drive_in_rpm() -> None:
    units = load_table("hilbed402").units.model_copy(
        update={"velocity": "rpm", "gear": 33.0, "polarity": -1, "counts_per_turn": 2000}
    )
    one_turn_a_second = 2 * 3.141592653589793
    assert units.velocity_scale() * one_turn_a_second == pytest.approx(-33 * 60)
    assert units.position_scale() * one_turn_a_second == pytest.approx(-33 * 2000)


def test_everything_wrong_is_told_at_once() -> None:
    with pytest.raises(ScenarioError) as caught:
        resolve({"left": NodeSpec(id=2), "steering": NodeSpec()}, ("left", "right"))
    assert str(caught.value).splitlines() == [
        "nodes: the robot has no drive 'steering'; it has left, right",
        "nodes: left and right have the same node number 2",
    ]


@pytest.mark.parametrize(
    ("block", "message"),
    [
        ({"kind": "virtual"}, "'simulated', 'ecu' or 'real'"),
        ({"kind": "simulated", "id": 0}, "greater than or equal to 1"),
        ({"id": 127}, "less than or equal to 126"),
        (
            {"table": "epos4"},
            "no drive table 'epos4'; known: hilbed402, hilbed402-csp, hilbed402-pp, zlac8015d",
        ),
        ({"table": "../hilbed402"}, "no drive table"),
        ({"loop": "pid"}, "variable_structure"),
        ({"gains": {"kq": 1.0}}, "hilbed402 has no 'kq'; it has .*kp"),
        ({"gains": {"slew": 1.0}}, "has no 'slew'"),
        ({"gains": {"kp": float("nan")}}, "finite"),
        ({"current_limit": -1}, "greater than 0"),
        ({"speed": 3}, "Extra inputs"),
    ],
)
def test_bad_nodes(block: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        NodeSpec.model_validate(block)


@pytest.mark.parametrize("bitrate", BIT_RATES)
def test_every_bit_rate_makes_a_wire(bitrate: int) -> None:
    assert Wire(BusSpec(bitrate=bitrate).bitrate).bitrate == bitrate


@pytest.mark.parametrize(
    ("block", "message"),
    [
        ({"bitrate": 300_000}, "no bit rate of CiA"),
        ({"silent": "panic"}, "quick_stop"),
        ({"silent_after": 0}, "greater than 0"),
    ],
)
def test_bad_buses(block: dict[str, Any], message: str) -> None:
    with pytest.raises(ValidationError, match=message):
        BusSpec.model_validate(block)


def changed(path: Path, **update: Any) -> Path:
    table = yaml.safe_load((TABLES / "hilbed402.yaml").read_text(encoding="utf-8"))
    path.write_text(yaml.safe_dump(table | update), encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("update", "message"),
    [
        ({"pdos": {}}, "no TPDO maps statusword"),
        ({"pdos": {"tpdo9": {"cob_id": 1, "map": []}}}, "tpdo9"),
        ({"pdos": {"rpdo1": {"cob_id": 0x200, "map": ["nothing"]}}}, "maps 'nothing'"),
        ({"pdos": {"rpdo1": {"cob_id": 0x200, "map": ["supply"] * 3}}}, "longer than 8 bytes"),
        ({"units": {"counts_per_turn": 0, "rated_current": 1}}, "units.counts_per_turn"),
        ({"colour": "red"}, "colour"),
    ],
)
def test_bad_tables_name_the_file(tmp_path: Path, update: dict[str, Any], message: str) -> None:
    path = changed(tmp_path / "mine.yaml", **update)
    with pytest.raises(ScenarioError, match=rf"mine\.yaml.*{message}"):
        read_table(path)


def test_tables_that_cannot_be_read(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match=r"absent\.yaml"):
        read_table(tmp_path / "absent.yaml")
    (tmp_path / "broken.yaml").write_text("a: [", encoding="utf-8")
    with pytest.raises(ScenarioError, match=r"broken\.yaml"):
        read_table(tmp_path / "broken.yaml")
