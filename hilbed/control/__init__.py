"""Controllers and the reference paths that they follow."""

from hilbed.control.lqr_spec import LqrSpec
from hilbed.control.open_loop import OpenLoopSpec
from hilbed.control.reference import ReferenceSpec

ControllerSpec = LqrSpec | OpenLoopSpec

__all__ = ["ControllerSpec", "LqrSpec", "OpenLoopSpec", "ReferenceSpec"]
