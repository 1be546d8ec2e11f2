"""Files that ship with the package: inside it when installed, beside it in a working copy."""

from __future__ import annotations

from pathlib import Path

from hilbed.types import ScenarioError


def package_file(name: str) -> Path:
    """Returns the path of a file of the package such as "urdf/diffdrive.urdf"; raises ScenarioError."""
    package = Path(__file__).resolve().parent
    roots = [package]
    if name.startswith("urdf/"):
        roots.append(package.parent)
    for root in roots:
        path = (root / name).resolve()
        if path.is_file() and path.is_relative_to(root):
            return path
    raise ScenarioError(f"package:{name}: no such file in the package")
