"""Controllers and the reference paths that they follow."""

from hilbed.control.cloud_spec import CloudSpec
from hilbed.control.front_point import FrontPointSpec
from hilbed.control.legs import LegsSpec
from hilbed.control.lqr_spec import LqrSpec
from hilbed.control.lyapunov_spec import LyapunovTrackingSpec
from hilbed.control.open_loop import OpenLoopSpec
from hilbed.control.path_following import PathFollowingSpec
from hilbed.control.point import PointSpec
from hilbed.control.ramps import RampsSpec
from hilbed.control.reference import CircleSpec, FigureEightSpec, LineSpec, StadiumSpec, WaypointsSpec

ControllerSpec = (
    LqrSpec | OpenLoopSpec | LyapunovTrackingSpec | PathFollowingSpec | RampsSpec | CloudSpec | FrontPointSpec
)

ReferenceSpec = LineSpec | CircleSpec | StadiumSpec | FigureEightSpec | WaypointsSpec | LegsSpec | PointSpec

ON_THEIR_OWN = ("path_following", "ramps")
"""Controllers that know themselves where to go: a reference is only there to be compared with."""

OWN_COMMAND = ("ramps",)
"""Controllers that speak the robot's own command; all others say v and w of the axle's midpoint."""

__all__ = ["ON_THEIR_OWN", "OWN_COMMAND", "ControllerSpec", "LqrSpec", "OpenLoopSpec", "ReferenceSpec"]
