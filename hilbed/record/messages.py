"""Messages of the MCAP log as ROS 2 ones (CDR, little-endian), packed by `struct` in half a microsecond."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from struct import Struct
from typing import NamedTuple

import numpy as np

from hilbed.types import Array, Transfer

_CDR = b"\x00\x01\x00\x00"
_MAP, _CHILD = b"map", b"base_link"
_SECOND = 1_000_000_000

_RULE = "=" * 80 + "\n"
_TIME = "MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n"
_HEADER = "MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n"
_QUATERNION = "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
_POSE = "MSG: geometry_msgs/Pose\ngeometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"
_POINT = "MSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n"
_VECTOR = "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
_TRANSFORM = (
    "MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"
)
_STAMPED = (
    "MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\n"
    "geometry_msgs/Transform transform\n"
)


class Definition(NamedTuple):
    """Name and text of a message definition, in the form of `ros2msg`."""

    name: str
    text: str


POSE = Definition(
    "geometry_msgs/msg/PoseStamped",
    _RULE.join(
        ["std_msgs/Header header\ngeometry_msgs/Pose pose\n", _HEADER, _TIME, _POSE, _POINT, _QUATERNION]
    ),
)
TRANSFORM = Definition(
    "tf2_msgs/msg/TFMessage",
    _RULE.join(
        [
            "geometry_msgs/TransformStamped[] transforms\n",
            _STAMPED, _HEADER, _TIME, _TRANSFORM, _VECTOR, _QUATERNION,
        ]
    ),
)  # fmt: skip
FRAME = Definition(
    "hilbed_msgs/msg/CanFrame",
    "float64 latency  # s, from queueing to the last bit\n"
    "float64 wait  # s, from queueing to the first bit\n"
    "float64 arbitration  # s, of the wait: other frames won the bus\n"
    "uint32 id\nbool extended\nbool remote\nuint8 length\n"
    "uint8 error  # 0, or what cut it off: 1 a wrong bit, 2 no acknowledgement\n"
    "uint8[8] data\nstring node\n",
)

_HEAD = [("cdr", "<u4"), ("sec", "<i4"), ("nanosec", "<u4"), ("length", "<u4"), ("frame", "S4")]
_PLACE = [("position", "<f8", 3), ("orientation", "<f8", 4)]
_POSES = np.dtype([*_HEAD, *_PLACE])
_TRANSFORMS = np.dtype(
    [_HEAD[0], ("count", "<u4"), *_HEAD[1:], ("child_length", "<u4"), ("child", "S16"), *_PLACE]
)
_pack_frame = Struct("<4s ddd I??BB 8s I").pack


def pose_messages(stamps: np.ndarray, poses: Array) -> np.ndarray:
    """Returns a PoseStamped in the frame `map` for each row of poses (n, 3) at its stamp (ns)."""
    return _placed(np.zeros(len(stamps), _POSES), stamps, poses)


def transform_messages(stamps: np.ndarray, poses: Array) -> np.ndarray:
    """Returns a TFMessage with the one transform `map` → `base_link` for each row of poses (n, 3)."""
    table = np.zeros(len(stamps), _TRANSFORMS)
    table["count"] = 1
    table["child"] = _CHILD
    table["child_length"] = len(_CHILD) + 1
    return _placed(table, stamps, poses)


def _placed(table: np.ndarray, stamps: np.ndarray, poses: Array) -> np.ndarray:
    table["cdr"] = int.from_bytes(_CDR, "little")
    table["sec"], table["nanosec"] = np.divmod(stamps, _SECOND)
    table["frame"] = _MAP
    table["length"] = len(_MAP) + 1
    table["position"][:, :2] = poses[:, :2]
    table["orientation"][:, 2] = np.sin(0.5 * poses[:, 2])
    table["orientation"][:, 3] = np.cos(0.5 * poses[:, 2])
    return table


def frame_message(transfer: Transfer, lost: float) -> bytes:
    """Returns a CanFrame with its way over the bus; lost: s in arbitration."""
    queued, start, end, (identifier, data, extended, remote), node, error = transfer
    name = node.encode() + b"\0"
    times = (end - queued) * 1e-9, (start - queued) * 1e-9, lost
    head = _pack_frame(_CDR, *times, identifier, extended, remote, len(data), error, data, len(name))
    return head + name


Groups = Mapping[str, Sequence[str]]


def numbers(name: str, groups: Groups) -> tuple[Definition, Callable[..., bytes]]:
    """Returns the definition of a message of numbers and what packs them, group after group, as bytes.

    groups: fields of each group, shown as `group.field` by plotting programs; those of the group "" belong
    to the message itself. A field may be an array, `covariance[9]`.
    """
    top, parts, count = [], [], 0
    for group, fields in groups.items():
        lines = [_field(field) for field in fields]
        if group:
            kind = f"{name}_{group}"
            top.append(f"hilbed_msgs/{kind} {group}\n")
            parts.append(f"MSG: hilbed_msgs/{kind}\n" + "".join(lines))
        else:
            top += lines
        count += sum(_size(field) for field in fields)
    definition = Definition(f"hilbed_msgs/msg/{name}", _RULE.join(["".join(top), *parts]))
    pack = Struct(f"<4s{count}d").pack
    return definition, lambda *values: pack(_CDR, *values)


def number_messages(values: Array) -> np.ndarray:
    """Returns a message of numbers for each row of values (n, m)."""
    count, width = values.shape
    table = np.zeros(count, np.dtype([("cdr", "<u4"), ("values", "<f8", (width,))]))
    table["cdr"] = int.from_bytes(_CDR, "little")
    table["values"] = values
    return table


def _size(field: str) -> int:
    return int(field.partition("[")[2].removesuffix("]") or 1)


def _field(field: str) -> str:
    name, bracket, size = field.partition("[")
    return f"float64{bracket}{size} {name}\n"
