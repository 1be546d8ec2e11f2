"""The versions that a run depends on."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version

from hilbed import __version__

PACKAGES = {"pybullet": "pybullet", "numpy": "numpy", "opencv": "opencv-python-headless"}


def versions() -> dict[str, str]:
    """Returns the versions of hilbed, pybullet, numpy and opencv."""
    return {"hilbed": __version__, **{name: _version(package) for name, package in PACKAGES.items()}}


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed"
