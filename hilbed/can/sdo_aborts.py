"""What the abort codes of SDO transfers mean (CiA 301, in own words)."""

from __future__ import annotations

TOGGLE, TIMEOUT, COMMAND, OUT_OF_MEMORY = 0x05030000, 0x05040000, 0x05040001, 0x05040005

_MEANINGS = {
    TOGGLE: "toggle bit did not alternate",
    TIMEOUT: "no answer in time",
    COMMAND: "unknown command",
    OUT_OF_MEMORY: "out of memory",
    0x06010000: "access not supported",
    0x06010001: "object can only be written",
    0x06010002: "object can only be read",
    0x06020000: "object does not exist",
    0x06040041: "object cannot be mapped to a PDO",
    0x06040042: "mapped objects are longer than the PDO",
    0x06040043: "parameters do not fit together",
    0x06040047: "incompatible inside the device",
    0x06060000: "hardware error",
    0x06070010: "length does not match the object",
    0x06070012: "too long for the object",
    0x06070013: "too short for the object",
    0x06090011: "sub-index does not exist",
    0x06090030: "value out of range",
    0x06090031: "value too large",
    0x06090032: "value too small",
    0x06090036: "maximum is below minimum",
    0x08000000: "general error",
    0x08000020: "cannot be stored",
    0x08000021: "not under local control",
    0x08000022: "not in the present device state",
    0x08000023: "no object dictionary",
    0x08000024: "no data",
}


def meaning(code: int) -> str:
    """Returns a short description of an abort code."""
    return _MEANINGS.get(code, "unknown reason")
