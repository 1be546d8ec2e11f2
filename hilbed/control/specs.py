"""Scenario blocks of the controllers."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from hilbed.control.lqr import LqrSpec
from hilbed.control.open_loop import OpenLoopSpec

ControllerSpec = Annotated[LqrSpec | OpenLoopSpec, Field(discriminator="kind")]
