"""The electronic data sheet, written from the object dictionary: `python -m firmware_sim.eds` prints it."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from firmware_sim.entry import VAR, Entry, Object
from firmware_sim.objects import OBJECTS
from firmware_sim.objects.pdo import PDOS

PATH = Path(__file__).with_name("hilbed402.eds")

_MANDATORY = (0x1000, 0x1001, 0x1018)
_HEAD = f"""\
[FileInfo]
FileName=hilbed402.eds
FileVersion=1
FileRevision=0
EDSVersion=4.0
Description=Simulated wheel drive of hilbed
CreationTime=12:00PM
CreationDate=01-01-2025
CreatedBy=hilbed

[DeviceInfo]
VendorName=hilbed
VendorNumber=0x0
ProductName=hilbed simulated drive
ProductNumber=0x402
RevisionNumber=0x10000
OrderCode=none
BaudRate_10=1
BaudRate_20=1
BaudRate_50=1
BaudRate_125=1
BaudRate_250=1
BaudRate_500=1
BaudRate_800=1
BaudRate_1000=1
SimpleBootUpMaster=0
SimpleBootUpSlave=1
Granularity=8
DynamicChannelsSupported=0
GroupMessaging=0
NrOfRXPDO={PDOS}
NrOfTXPDO={PDOS}
LSS_Supported=0

[DummyUsage]
{"".join(f"Dummy{i:04d}=0" + chr(10) for i in range(1, 8))}
[Comments]
Lines=3
Line1=Velocities are encoder counts per second at the wheel, accelerations counts per second squared.
Line2=Positions are encoder counts; object 2001 holds the counts of one turn of the wheel.
Line3=Manufacturer objects 2xxx are in SI units unless their name says otherwise.
"""


def text() -> str:
    """Returns the whole file."""
    groups = {
        "MandatoryObjects": [o for o in OBJECTS if o.index in _MANDATORY],
        "OptionalObjects": [o for o in OBJECTS if o.index not in _MANDATORY and not _manufacturer(o)],
        "ManufacturerObjects": [o for o in OBJECTS if _manufacturer(o)],
    }
    lists = (_list(name, objects) for name, objects in groups.items())
    return "\n".join((_HEAD, *lists, *(_object(o) for objects in groups.values() for o in objects)))


def _manufacturer(described: Object) -> bool:
    return 0x2000 <= described.index < 0x6000


def _section(name: str, pairs: Iterable[tuple[str, object]]) -> str:
    return f"[{name}]\n" + "".join(f"{k}={v}\n" for k, v in pairs)


def _list(name: str, objects: list[Object]) -> str:
    numbered = ((str(i), f"0x{o.index:04X}") for i, o in enumerate(objects, 1))
    return _section(name, (("SupportedObjects", len(objects)), *numbered))


def _object(described: Object) -> str:
    index, entries = described.index, described.entries
    if described.kind == VAR:
        return _section(f"{index:04X}", _entry(entries[0]))
    head = (
        ("ParameterName", described.name),
        ("ObjectType", f"0x{described.kind:X}"),
        ("SubNumber", len(entries)),
    )
    subs = (_section(f"{index:04X}sub{entry.sub:X}", _entry(entry)) for entry in entries)
    return "\n".join((_section(f"{index:04X}", head), *subs))


def _entry(entry: Entry) -> list[tuple[str, object]]:
    choices = entry.choices or (None,)
    low = choices[0] if entry.low is None else entry.low
    high = choices[-1] if entry.high is None else entry.high
    pairs: list[tuple[str, object]] = [
        ("ParameterName", entry.name),
        ("ObjectType", "0x7"),
        ("DataType", f"0x{entry.type.code:04X}"),
        ("AccessType", entry.access),
        ("DefaultValue", f"$NODEID+0x{entry.default:X}" if entry.relative else entry.default),
        ("PDOMapping", int(entry.mappable)),
    ]
    limits = (("LowLimit", low), ("HighLimit", high))
    return pairs + [(name, value) for name, value in limits if value is not None]


if __name__ == "__main__":
    print(text(), end="")
