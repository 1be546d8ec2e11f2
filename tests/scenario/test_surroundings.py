"""Scenery and beacons that cannot be shown are told with file and line."""

from __future__ import annotations

from pathlib import Path

import pytest

from hilbed.scenario.load import load
from hilbed.types import ScenarioError

HEAD = """\
robot: {kind: diffdrive}
duration: 1
estimator: ekf
controller: lqr
reference: {kind: stadium, straight: 4.0, radius: 2.0}
sensors: {camera: {kind: camera}}
plant:
  kind: bullet
"""
BEACONS = "  beacons:\n    - {at: [3, 0]}\n    - {at: [0, 3], colour: blue}\n"


def problem(tmp_path: Path, plant: str) -> str:
    file = tmp_path / "scene.yaml"
    file.write_text(HEAD + plant)
    with pytest.raises(ScenarioError) as caught:
        load(str(file))
    return str(caught.value)


@pytest.mark.parametrize(
    ("plant", "message"),
    [
        ("  scenery: desert\n" + BEACONS, "scene.yaml:9: plant.scenery: 'desert' is none of void, arena"),
        (
            "  scenery: {walls: {corner: [-1, -1], opposite: [1, 5]}}\n" + BEACONS,
            "scene.yaml:11: plant.beacons.0.at: [3, 0] is not between the walls, [-1, -1] … [1, 5]",
        ),
        (
            BEACONS + "  scenery:\n    walls: {}\n    objects:\n      - {at: [9, 0]}\n",
            "scene.yaml:15: plant.scenery.objects.0.at: [9, 0] is not between the walls",
        ),
        (
            BEACONS + "  scenery:\n    walls: {}\n    objects:\n      - {path: [[0, 0], [0, 9]]}\n",
            "scene.yaml:15: plant.scenery.objects.0.path: [0, 9] is not between the walls",
        ),
        (
            BEACONS + "  scenery:\n    floor: {patern: wood}\n",
            "scene.yaml:13: unknown key 'patern'; did you mean 'pattern'?",
        ),
        (
            "  beacons:\n    - {at: [3, 0], shape: cone, marker: 1}\n",
            "scene.yaml:10: plant.beacons.0: a cone carries no marker",
        ),
        (
            "  beacons:\n" + 256 * "    - {at: [3, 0]}\n",
            "scene.yaml:9: plant.beacons: a camera tells at most 255 apart, not 256",
        ),
    ],
    ids=["word", "beacon", "object", "path", "key", "marker", "count"],
)
def test_what_cannot_be_shown_is_told_with_its_line(tmp_path: Path, plant: str, message: str) -> None:
    assert message in problem(tmp_path, plant)
