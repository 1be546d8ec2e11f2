from __future__ import annotations

import json
import re
from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from hilbed.report import write_report
from hilbed.report.style import thinned
from hilbed.types import HilbedError
from tests.report import synthetic

VOID = {"meta", "link", "br", "img", "input", "hr"}


class Page(HTMLParser):
    """Checks that elements are closed in order, and collects what the tests ask for."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.titles: list[str] = []
        self.figures: list[str] = []
        self.loads: list[str] = []
        self.words: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        named = dict(attrs)
        if tag not in VOID:
            self.open.append(tag)
        if tag == "svg":
            self.figures.append(named.get("aria-label") or "")
        if tag in ("script", "link", "img", "iframe"):
            self.loads.append(tag)
        self.loads += [value or "" for name, value in attrs if name in ("src", "xlink:href") and value]

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "image":
            self.loads.append(str(dict(attrs)["href"])[:22])

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.words.append(data)
        if self.open and self.open[-1] == "h2":
            self.titles.append(data)


def page_of(folder: Path) -> Page:
    page = Page(write_report(folder).read_text())
    assert page.open == []
    return page


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return synthetic.write(tmp_path_factory.mktemp("runs") / "demo-1")


def part(tmp_path: Path, keep: Callable[[str], bool], reason: str = "") -> Page:
    return page_of(synthetic.write(tmp_path / "part", keep, reason))


def test_a_full_run_has_every_section_on_one_page(run: Path) -> None:
    page = page_of(run)
    assert page.titles == [
        "Criteria", "Cost", "Path", "Error of the estimate", "Wheel speeds", "Duties, currents, loads",
        "Distance to truth", "Slip: surface of the wheel against the ground", "Azimuth residuals, by beacon",
        "Innovations", "Bus load in each 0.1 s", "Bus latency by identifier", "Camera",
        "Frames by identifier", "Metrics", "Scenario",
    ]  # fmt: skip
    text = "".join(page.words)
    for word in (
        "failed",
        "left.load_dip",
        "load torque · left",
        "10–15 s",
        "wheel_radius: 0.1",
        "3f2a" * 16,
    ):
        assert word in text
    assert (run / "report.html").stat().st_size < 3e6


def test_the_page_needs_nothing_from_elsewhere(run: Path) -> None:
    page = page_of(run)
    outside = [one for one in page.loads if not one.startswith(("data:image/png;base64,", "#"))]
    assert outside == []
    assert sum(one.startswith("data:") for one in page.loads) == 12
    text = (run / "report.html").read_text()
    assert not re.search(r"url\((?!#)", text)
    assert "#0a0b" not in text, "every stand-in colour has become a variable of the page"
    assert "nan" not in re.findall(r' d="[^"]*"', text)


def test_the_same_run_gives_the_same_page(run: Path) -> None:
    first = write_report(run).read_bytes()
    assert write_report(run).read_bytes() == first


def test_a_recorded_robot_has_neither_drives_nor_camera(tmp_path: Path) -> None:
    page = part(tmp_path, lambda name: "drive" not in name and not name.startswith(("tick", "bus")))
    assert "Wheel speeds" not in page.titles
    assert "Bus load in each 0.1 s" not in page.titles
    assert "Azimuth residuals, by beacon" in page.titles


def test_an_ideal_run_has_poses_alone(tmp_path: Path) -> None:
    page = part(tmp_path, lambda name: name in ("t", "truth", "estimate", "reference", "covariance"))
    assert page.titles[2:5] == ["Path", "Error of the estimate", "Distance to truth"]


def test_a_run_without_truth_still_shows_its_path(tmp_path: Path) -> None:
    page = part(tmp_path, lambda name: name in ("t", "estimate", "covariance", "odometry"))
    assert "Path" in page.titles
    assert "Error of the estimate" not in page.titles


@pytest.mark.parametrize("rows", [0, 1, 7])
def test_an_aborted_run_says_why(tmp_path: Path, rows: int, monkeypatch: pytest.MonkeyPatch) -> None:
    whole = synthetic.signals(2.0)
    cut = {name: column[:rows] for name, column in whole.items()}
    monkeypatch.setattr(synthetic, "signals", lambda: cut)
    page = part(tmp_path, lambda _: True, "the robot fell over at t = 0.07 s <culprit>")
    assert "the robot fell over at t = 0.07 s <culprit>" in page.words
    assert "failed" in page.words


def test_a_broken_folder_is_told_by_name(run: Path, tmp_path: Path) -> None:
    with pytest.raises(HilbedError, match="nowhere is not a folder"):
        write_report(tmp_path / "nowhere")
    with pytest.raises(HilbedError, match=r"scenario\.yaml: No such file"):
        write_report(tmp_path)
    names = ("scenario.yaml", "verdict.json", "signals.npz")
    for name, content in zip(names, (b"a: [", b"{", b"PK\x03\x04 no"), strict=True):
        folder = tmp_path / name
        folder.mkdir()
        for other in names:
            (folder / other).write_bytes(content if other == name else (run / other).read_bytes())
        with pytest.raises(HilbedError, match=name.replace(".", r"\.")):
            write_report(folder)


def test_a_verdict_of_another_shape_is_told(run: Path, tmp_path: Path) -> None:
    for name in ("scenario.yaml", "signals.npz"):
        (tmp_path / name).write_bytes((run / name).read_bytes())
    (tmp_path / "verdict.json").write_text(json.dumps({"passed": True}))
    with pytest.raises(HilbedError, match=r"verdict\.json"):
        write_report(tmp_path)


def test_signals_that_do_not_fit_together_are_told(tmp_path: Path) -> None:
    folder = synthetic.write(tmp_path / "odd")
    with np.load(folder / "signals.npz") as archive:
        signals = dict(archive)
    signals["estimate"] = signals["estimate"][:-5]
    np.savez(folder / "signals.npz", **signals)
    with pytest.raises(HilbedError, match="cannot be shown"):
        write_report(folder)


def test_thinning_keeps_the_extremes_and_the_ends() -> None:
    rng = np.random.default_rng(0)
    t = np.arange(60001) * 1e-3
    value = rng.normal(size=60001)
    value[31234] = 50.0
    thin_t, thin_value = thinned(t, value)
    assert len(thin_t) < 1500
    assert thin_value.max() == 50.0
    assert thin_value.min() == value.min()
    assert (np.diff(thin_t) > 0).all()
    assert thin_t[-1] > 59.9


def test_the_table_of_frames_adds_up(tmp_path: Path) -> None:
    """Two error frames of one identifier; latency is queueing, arbitration and transfer."""
    from hilbed.criteria import Signals
    from hilbed.report import bus_table
    from hilbed.report.run import read_run

    run = read_run(synthetic.write(tmp_path / "run"))
    signals = Signals(
        {
            "bus/t": np.array([-1.0, 0.01, 0.02, 0.03, 0.031, 0.04]),
            "bus/latency": np.array([9, 300, 500, 200, 250, 700]) * 1e-6,
            "bus/duration": np.full(6, 200e-6),
            "bus/arbitration": np.array([0, 0, 300, 0, 0, 400]) * 1e-6,
            "bus/id": np.array([0x181, 0x181, 0x181, 0x181, 0x181, 0x123]),
            "bus/error": np.array([0, 0, 0, 1, 1, 0]),
        }
    )
    table = bus_table.frames(run._replace(signals=signals))
    assert table is not None
    rows = [re.findall(r"<t[dh][^>]*>(?:<code>)?([^<]*)", row) for row in table.split("<tr>")[2:]]
    assert rows == [
        ["0x123", "", "1", "", "100 · 100", "400 · 400", "200 · 200", ""],
        ["0x181", "TPDO1, node 1", "2", "9.8", "50 · 100", "150 · 300", "200 · 200", "2"],
    ]
    assert bus_table.frames(run._replace(signals=Signals(t=np.zeros(3)))) is None


@pytest.mark.parametrize(
    ("identifier", "name"),
    [
        (0x000, "NMT"),
        (0x080, "SYNC"),
        (0x085, "EMCY, node 5"),
        (0x77F, "heartbeat, controller"),
        (0x123, ""),
        (0x1FFE0001, ""),
    ],
)
def test_identifiers_are_named_as_canopen_does(identifier: int, name: str) -> None:
    from hilbed.report.bus_table import name_of

    assert name_of(identifier) == name


def test_positions_and_counters_are_shown_where_there_are_any(run: Path, tmp_path: Path) -> None:
    folder = synthetic.write(tmp_path / "positions")
    with np.load(folder / "signals.npz") as archive:
        signals = dict(archive)
    for kind, size in (("pose", 3), ("front", 2)):
        true = signals["truth"][::10, :size]
        measured = true + 0.01
        measured[3] = np.nan
        signals |= {f"{kind}/t": signals["t"][::10], f"{kind}/true": true, f"{kind}/measured": measured}
    np.savez(folder / "signals.npz", **signals)
    verdict = json.loads((folder / "verdict.json").read_text())
    verdict["counts"] = {"estimator": {"ignored": 17, "effective": None}, "controller": {}}
    (folder / "verdict.json").write_text(json.dumps(verdict))
    page, before = page_of(folder), page_of(run)
    assert set(page.titles) - set(before.titles) == {"Position residuals", "Counted"}
    assert set(page.figures) - set(before.figures) == {"position residuals"}
    assert "17" in page.words
    assert {"ignored", "effective"} <= set(page.words)
