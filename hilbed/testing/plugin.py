"""The pytest plugin: fixtures of rendered frames with truth, and a marker for degradations.

Every run of pytest imports this module wherever hilbed is installed, so it imports nothing of the bench by
itself and does nothing to tests that use none of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from hilbed.scenario.load import Loaded
    from hilbed.vision_kit.archive import Archive
    from hilbed.vision_kit.labelled import LabelledShot
    from hilbed.vision_kit.studio import Studio

SCENARIO = "vision/clean"
SCENE = "hilbed"
DEGRADED = "hilbed_degraded"
DEGRADATION = "hilbed_degradation"

_MARKERS = (
    f"{SCENE}(scenario={SCENARIO!r}, frames=20, seed=None, set=[]): what hilbed's fixtures show; set: "
    "'PATH=VALUE' as on the command line",
    f"{DEGRADED}(name='PATH=VALUE', …): the test runs once for each name, with hilbed's camera degraded so; "
    "a list for more than one value, '' for none",
)


def pytest_configure(config: pytest.Config) -> None:
    for line in _MARKERS:
        config.addinivalue_line("markers", line)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    marker = metafunc.definition.get_closest_marker(DEGRADED)
    if marker is None:
        return
    if DEGRADATION not in metafunc.fixturenames:
        raise pytest.Collector.CollectError(
            f"{metafunc.definition.nodeid}: {DEGRADED} is for tests with hilbed_frame, hilbed_camera or "
            "hilbed_dataset"
        )
    cases = {name: settings_of(value) for name, value in marker.kwargs.items()}
    metafunc.parametrize(DEGRADATION, list(cases.values()), ids=list(cases), indirect=True)


def settings_of(value: str | list[str]) -> list[str]:
    """Returns `PATH=VALUE` settings from one, from a list of them, or from an empty word."""
    return [value] if isinstance(value, str) and value else list(value)


@pytest.fixture
def hilbed_degradation(request: pytest.FixtureRequest) -> list[str]:
    """What degrades the camera in this test, as `PATH=VALUE`."""
    return list(getattr(request, "param", []))


@pytest.fixture
def hilbed_camera(request: pytest.FixtureRequest, hilbed_degradation: list[str]) -> Iterator[Studio]:
    """A camera over a path: iterate for its frames with truth, or take one `at(x, y, yaw)`."""
    from hilbed.vision_kit.studio import Studio, Subject

    with Studio(Subject(_loaded(request, hilbed_degradation))) as studio:
        yield studio


@pytest.fixture
def hilbed_frame(hilbed_camera: Studio) -> LabelledShot:
    """One rendered frame: `.shot` is what a detector gets, `.truth` what it should find."""
    return hilbed_camera.take(0)


@pytest.fixture
def hilbed_dataset(request: pytest.FixtureRequest, hilbed_degradation: list[str], tmp_path: Any) -> Archive:
    """A dataset on disk as `hilbed frames` writes it; `.folder` is where, `.shots()` reads it."""
    from hilbed.vision_kit.archive import Archive
    from hilbed.vision_kit.dataset import plan, write_dataset

    folder = tmp_path / "hilbed-dataset"
    write_dataset(plan(_loaded(request, hilbed_degradation)), folder, False, lambda _: None)
    return Archive(folder)


def _loaded(request: pytest.FixtureRequest, degradation: list[str]) -> Loaded:
    """Reads the scenario that the nearest marker names; a mistake in it fails the test by its message."""
    from hilbed.scenario.load import load
    from hilbed.types import ScenarioError

    asked = _asked(request)
    settings = [f"vision.frames={asked['frames']}", *settings_of(asked["set"]), *degradation]
    try:
        return load(asked["scenario"], settings, asked["seed"])
    except ScenarioError as error:
        pytest.fail(str(error), pytrace=False)


def _asked(request: pytest.FixtureRequest) -> Mapping[str, Any]:
    defaults = {"scenario": SCENARIO, "frames": 20, "seed": None, "set": []}
    marker = request.node.get_closest_marker(SCENE)
    given = {} if marker is None else marker.kwargs
    unknown = ", ".join(sorted(set(given) - set(defaults)))
    if unknown or (marker is not None and marker.args):
        wrong = unknown or "values without a name"
        pytest.fail(f"marker {SCENE} takes {', '.join(defaults)} by name, not {wrong}", pytrace=False)
    return {**defaults, **given}
