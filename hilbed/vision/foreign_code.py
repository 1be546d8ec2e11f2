"""Loads a foreign detector's class, and says where in its code something went wrong. For its own process."""

from __future__ import annotations

import importlib
import importlib.util
import sys
import traceback
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path
from types import ModuleType
from typing import Any

from hilbed.vision.code import Code

_HERE = str(Path(__file__).parents[1])
_LONGEST = 500  # characters of a message


class Refused(Exception):
    """The code cannot be used, and why."""


def make(code: Code, options: Mapping[str, Any]) -> Any:
    """Returns the detector that a class in a module or a file is made into; raises Refused."""
    detector = find_class(code)
    try:
        return detector(**options)
    except BaseException as error:
        raise Refused(f"making {detector.__name__}({_given(options)}) failed: {blame(error)}") from None


def find_class(code: Code) -> type:
    """Returns the class that code names; raises Refused where there is none, or it has no method `detect`."""
    module = _module(code)
    if not code.name:
        return _only(module, code)
    found = getattr(module, code.name, None)
    if found is None:
        close = get_close_matches(code.name, dir(module), n=1)
        meant = f"; did you mean {close[0]}?" if close else ""
        raise Refused(f"there is no class {code.name} in {code.place}{meant}")
    if not isinstance(found, type):
        raise Refused(f"{code.name} in {code.place} is not a class")
    if not _detects(found):
        raise Refused(f"class {code.name} in {code.place} has no method detect(shot)")
    return found


def _only(module: ModuleType, code: Code) -> type:
    classes = [one for one in vars(module).values() if isinstance(one, type)]
    found = [one for one in classes if one.__module__ == module.__name__ and _detects(one)]
    if len(found) == 1:
        return found[0]
    if not found:
        raise Refused(f"{code.place} has no class with a method detect(shot)")
    names = ", ".join(one.__name__ for one in found)
    raise Refused(f"{code.place} has several detectors ({names}): name one, {code.place}:{found[0].__name__}")


def _detects(found: type) -> bool:
    return callable(getattr(found, "detect", None))


def _module(code: Code) -> ModuleType:
    try:
        return _from_file(Path(code.place)) if code.is_file else importlib.import_module(code.place)
    except ModuleNotFoundError as error:
        if not code.is_file and error.name and f"{code.place}.".startswith(f"{error.name}."):
            file = f"{code.place.rpartition('.')[2]}.py:{code.name}"
            told = f"no module {error.name} is installed"
            raise Refused(f"{told}; a file is given by its path, {file}") from None
        raise Refused(f"importing {code.place} failed: {blame(error)}") from None
    except BaseException as error:
        raise Refused(f"importing {code.place} failed: {blame(error)}") from None


def _from_file(path: Path) -> ModuleType:
    sys.path.append(str(path.parent))  # at the end: its neighbours hide nobody else's modules
    name = path.stem if path.stem not in sys.modules else f"{path.stem}_"
    spec = importlib.util.spec_from_file_location(name, path)
    if spec is None or spec.loader is None:
        raise ImportError(f"{path} is not a Python file")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


def _given(options: Mapping[str, Any]) -> str:
    return ", ".join(f"{name}={value!r}" for name, value in options.items())


def blame(error: BaseException) -> str:
    """Returns `file:line in function: what`, the innermost place that is not a library's, if any is."""
    if isinstance(error, SyntaxError) and error.filename:
        return f"{error.filename}:{error.lineno}: {type(error).__name__}: {error.msg}"
    frames = [one for one in traceback.extract_tb(error.__traceback__) if _foreign(one.filename)]
    frames = [one for one in frames if "site-packages" not in one.filename] or frames
    what = "".join(traceback.format_exception_only(error)).strip()
    what = what if len(what) <= _LONGEST else what[:_LONGEST] + "…"
    return f"{frames[-1].filename}:{frames[-1].lineno} in {frames[-1].name}: {what}" if frames else what


def _foreign(file: str) -> bool:
    return not file.startswith((_HERE, "<frozen", sys.base_prefix + "/lib/"))
