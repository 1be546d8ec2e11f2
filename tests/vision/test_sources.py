"""Cameras that nobody renders for, and what is wrong with what they deliver."""

from __future__ import annotations

from collections.abc import Callable
from math import pi
from pathlib import Path
from time import sleep
from typing import Any

import cv2
import numpy as np
import pytest

from hilbed.types import ScenarioError
from hilbed.vision.calibration import Optics, read_lens
from hilbed.vision.image_file import read_image
from hilbed.vision.image_folder import ImageFolder
from hilbed.vision.lens import Lens
from hilbed.vision.live import CameraLost, LiveCamera
from hilbed.vision.video import VideoFile
from tests.vision.mjpeg import HEIGHT, WIDTH, camera

RIGHT_ANGLE = Optics(None, pi / 2)
COLOUR = np.dstack([np.full((48, 64), value, np.uint8) for value in (200, 100, 50)])  # red, green, blue


def save(path: Path, image: Any = COLOUR) -> Path:
    bgr = image[:, :, ::-1] if image.ndim == 3 and image.shape[2] == 3 else image
    done, data = cv2.imencode(path.suffix, bgr)
    assert done
    path.write_bytes(data.tobytes())
    return path


def movie(path: Path, frames: int = 10, fourcc: str = "MJPG") -> Path:
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*fourcc), 20.0, (64, 48))
    for k in range(frames):
        writer.write(np.full((48, 64, 3), 10 * k, np.uint8))
    writer.release()
    return path


def calibrate(path: Path, **changes: Any) -> Path:
    values = {
        "image_width": 64, "image_height": 48,
        "camera_matrix": np.array([[50.0, 0.0, 31.0], [0.0, 51.0, 24.0], [0.0, 0.0, 1.0]]),
        "distortion_coefficients": np.array([[-0.1, 0.02, 0.001, 0.002, 0.003]]),
        **changes,
    }  # fmt: skip
    storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
    for name, value in values.items():
        if value is not None:
            storage.write(name, value)
    storage.release()
    return path


def test_an_image_is_rgb(tmp_path: Path) -> None:
    assert read_image(save(tmp_path / "a.png"))[7, 9].tolist() == [200, 100, 50]
    assert np.abs(read_image(save(tmp_path / "a.jpg"))[7, 9].astype(int) - [200, 100, 50]).max() <= 3


def test_grey_is_a_colour(tmp_path: Path) -> None:
    image = read_image(save(tmp_path / "a.png", COLOUR[:, :, 0]))
    assert image.shape == (48, 64, 3)
    assert (image == 200).all()


@pytest.mark.parametrize(
    ("image", "words"),
    [
        (np.zeros((48, 64, 4), np.uint8), "has 4 channels, a frame has 3"),
        (np.zeros((48, 64, 3), np.uint16), "has 16 bits a channel"),
    ],
)
def test_other_channels_are_refused(tmp_path: Path, image: Any, words: str) -> None:
    with pytest.raises(ScenarioError, match=rf"a\.png: {words}"):
        read_image(save(tmp_path / "a.png", image))


@pytest.mark.parametrize("suffix", [".png", ".jpg"])
@pytest.mark.parametrize("part", [0.3, 0.6, 0.95])
def test_an_image_that_is_cut_off_is_refused(tmp_path: Path, suffix: str, part: float) -> None:
    noise = np.random.default_rng(1).integers(0, 256, (48, 64, 3), np.uint8)
    path = save(tmp_path / f"a{suffix}", noise)
    data = path.read_bytes()
    path.write_bytes(data[: int(part * len(data))])
    with pytest.raises(ScenarioError, match=rf"a\{suffix}: the image is cut off"):
        read_image(path)


@pytest.mark.parametrize("data", [b"", b"not an image at all", bytes(2000)])
def test_what_is_no_image_is_refused(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.png").write_bytes(data)
    with pytest.raises(ScenarioError, match=r"a\.png: is no image"):
        read_image(tmp_path / "a.png")
    with pytest.raises(ScenarioError, match=r"b\.png: No such file"):
        read_image(tmp_path / "b.png")


def test_a_folder_is_read_in_the_order_of_its_names(tmp_path: Path) -> None:
    for k, name in enumerate(("c.jpg", "a.png", "b.PNG")):
        save(tmp_path / name.lower(), np.full((48, 64, 3), 50 * k, np.uint8)).rename(tmp_path / name)
    (tmp_path / "notes.txt").write_text("no image")
    source = ImageFolder(tmp_path, RIGHT_ANGLE, rate=10.0)
    assert len(source) == 3
    assert [(shot.t, int(shot.image[0, 0, 0])) for shot in source.frames()] == [
        (0, 50),
        (10**8, 100),
        (2 * 10**8, 0),
    ]
    assert source.lens == Lens.of_fov(64, 48, pi / 2)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("frames.jsonl", '{"t": 0.5, "file": "a.png", "pan": 1}\n{"t": 0.7, "file": "b.png"}\n'),
        ("stamps.txt", "# seconds file\n0.5 a.png\n\n0.7 b.png\n"),
    ],
)
def test_stamps_are_taken_where_there_are_some(tmp_path: Path, name: str, text: str) -> None:
    for image in ("a.png", "b.png"):
        save(tmp_path / image)
    (tmp_path / name).write_text(text)
    assert [shot.t for shot in ImageFolder(tmp_path, RIGHT_ANGLE).frames()] == [5 * 10**8, 7 * 10**8]


@pytest.mark.parametrize("line", ["0.5", "soon a.png", "nan a.png"])
def test_a_stamp_that_is_none_is_told_with_its_line(tmp_path: Path, line: str) -> None:
    save(tmp_path / "a.png")
    (tmp_path / "stamps.txt").write_text(f"# stamps\n{line}\n")
    with pytest.raises(ScenarioError, match=r"stamps\.txt:2: does not say a time"):
        ImageFolder(tmp_path, RIGHT_ANGLE)


def test_an_image_without_a_stamp_is_told(tmp_path: Path) -> None:
    save(tmp_path / "a.png")
    (tmp_path / "stamps.txt").write_text("0.5 b.png\n")
    with pytest.raises(ScenarioError, match=r"a\.png: has no stamp"):
        list(ImageFolder(tmp_path, RIGHT_ANGLE).frames())


def test_images_of_several_sizes_are_told(tmp_path: Path) -> None:
    save(tmp_path / "a.png")
    save(tmp_path / "b.png", COLOUR[:40])
    frames = ImageFolder(tmp_path, RIGHT_ANGLE).frames()
    next(frames)
    with pytest.raises(ScenarioError, match=r"b\.png: has 64×40 pixels, but .* 64×48"):
        next(frames)


def test_an_empty_folder_is_told(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="there is no image in it"):
        ImageFolder(tmp_path, RIGHT_ANGLE)


def test_a_calibration_is_opencv_s(tmp_path: Path) -> None:
    lens = read_lens(calibrate(tmp_path / "calibration.yaml"))
    assert lens == Lens(64, 48, 50.0, 51.0, 31.0, 24.0, -0.1, 0.02, 0.001, 0.002, 0.003)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"image_width": None}, "image_width is missing"),
        ({"camera_matrix": None}, "camera_matrix is missing"),
        ({"camera_matrix": np.eye(2)}, "camera_matrix is 2×2"),
        ({"camera_matrix": np.array([[50.0, 1.0, 31.0], [0, 51.0, 24.0], [0, 0, 1.0]])}, "a skew of 1"),
        ({"camera_matrix": np.array([[-50.0, 0, 31.0], [0, 51.0, 24.0], [0, 0, 1.0]])}, "fx is -50"),
        ({"distortion_coefficients": np.full((1, 8), 0.1)}, "has 8 distortion coefficients"),
        ({"distortion_coefficients": np.array([[-9.0, 0, 0, 0, 0]])}, "folds the image"),
        ({"image_width": 7}, "camera width is 7"),
    ],
)
def test_a_calibration_that_cannot_be_used_is_told(
    tmp_path: Path, changes: dict[str, Any], words: str
) -> None:
    with pytest.raises(ScenarioError, match=rf"calibration\.yaml: .*{words}"):
        read_lens(calibrate(tmp_path / "calibration.yaml", **changes))


@pytest.mark.parametrize("text", ["", "a: [1, 2", "%YAML:1.0\n---\nx: [", "\x00\x01"])
def test_what_is_no_calibration_is_told(tmp_path: Path, text: str) -> None:
    (tmp_path / "c.yaml").write_text(text)
    with pytest.raises(ScenarioError, match=r"c\.yaml: "):
        read_lens(tmp_path / "c.yaml")


@pytest.mark.parametrize("source", ["folder", "video"])
def test_a_calibration_that_does_not_fit_the_images_is_told(tmp_path: Path, source: str) -> None:
    optics = Optics(Lens.of_fov(640, 480, 1.0), 0.0)
    save(tmp_path / "a.png")
    video = movie(tmp_path / "v.avi")
    make: Callable[[], object] = {
        "folder": lambda: ImageFolder(tmp_path, optics), "video": lambda: VideoFile(video, optics),
    }[source]  # fmt: skip
    with pytest.raises(ScenarioError, match=r"does not fit: it is of images of 640×480 pixels, but .* 64×48"):
        make()


@pytest.mark.parametrize(("name", "fourcc"), [("v.avi", "MJPG"), ("v.mp4", "mp4v")])
def test_a_video_is_read_frame_by_frame_at_its_times(tmp_path: Path, name: str, fourcc: str) -> None:
    source = VideoFile(movie(tmp_path / name, fourcc=fourcc), RIGHT_ANGLE)
    shots = list(source.frames())
    source.close()
    assert [shot.t for shot in shots] == pytest.approx([5e7 * k for k in range(10)], abs=1e6)
    assert [float(shot.image.mean()) for shot in shots] == pytest.approx([10 * k for k in range(10)], abs=4)


def test_of_a_video_that_is_cut_off_what_is_left_is_read(tmp_path: Path) -> None:
    path = movie(tmp_path / "v.avi", frames=20)
    data = path.read_bytes()
    path.write_bytes(data[: 3 * len(data) // 4])
    source = VideoFile(path, RIGHT_ANGLE)
    assert 3 <= len(list(source.frames())) < 20
    source.close()


@pytest.mark.parametrize("data", [b"", b"no video", bytes(5000)])
def test_what_is_no_video_is_told(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "v.mp4").write_bytes(data)
    with pytest.raises(ScenarioError, match=r"v\.mp4: is no video that can be read"):
        VideoFile(tmp_path / "v.mp4", RIGHT_ANGLE)
    with pytest.raises(ScenarioError, match="there is no file"):
        VideoFile(tmp_path / "w.mp4", RIGHT_ANGLE)


def test_a_stream_gives_its_newest_frames_and_ends() -> None:
    with camera(frames=40) as url:
        source = LiveCamera(url, RIGHT_ANGLE, timeout=10.0)
        shots = list(source.frames())
        source.close()
    assert source.lens == Lens.of_fov(WIDTH, HEIGHT, pi / 2)
    assert len(shots) > 1
    stamps, light = [shot.t for shot in shots], [float(shot.image.mean()) for shot in shots]
    assert stamps == sorted(set(stamps))
    assert light == sorted(light)
    assert light[-1] == pytest.approx(2 * 39 + 10, abs=2)


def test_frames_that_nobody_had_time_for_are_left_out() -> None:
    with camera(frames=40) as url:
        source = LiveCamera(url, RIGHT_ANGLE, timeout=10.0)
        sleep(2.0)  # far longer than the stream is
        assert len(list(source.frames())) <= 2


def test_a_stream_that_stalls_is_lost_after_its_timeout() -> None:
    with camera(frames=30, stalls=True) as url:
        source = LiveCamera(url, RIGHT_ANGLE, timeout=1.0)
        with pytest.raises(CameraLost, match=r"no frame for 1 s"):
            list(source.frames())
        source.close()


def test_a_camera_may_take_longer_to_open_than_for_a_frame() -> None:
    with camera(frames=20, late=1.5) as url:
        source = LiveCamera(url, RIGHT_ANGLE, timeout=1.0)
        assert next(source.frames()).image.shape == (HEIGHT, WIDTH, 3)
        source.close()


@pytest.mark.parametrize("place", [63, "http://127.0.0.1:9/nothing.mjpg"])
def test_a_camera_that_is_not_there_is_told(place: int | str) -> None:
    with pytest.raises(ScenarioError, match=r"(camera 63|nothing\.mjpg): (cannot be opened|gives no frame)"):
        LiveCamera(place, RIGHT_ANGLE, timeout=2.0)


def test_a_stream_whose_size_the_calibration_does_not_fit_is_told() -> None:
    with camera(frames=5) as url, pytest.raises(ScenarioError, match="does not fit"):
        LiveCamera(url, Optics(Lens.of_fov(640, 480, 1.0), 0.0), timeout=5.0)
