"""Scenario keys of a camera's optics, shutter and chip: every flaw is off by default."""

from __future__ import annotations

from math import degrees, radians
from typing import Annotated, Self

from pydantic import Field, model_validator

from hilbed.spec import Finite, Fraction, Positive, Spec
from hilbed.types import ScenarioError
from hilbed.vision.lens import LARGEST, SMALLEST, STEEPEST, Lens

Size = Annotated[int, Field(ge=SMALLEST, le=LARGEST)]
Tilt = Annotated[float, Field(ge=-degrees(STEEPEST), le=degrees(STEEPEST))]
Seconds = Annotated[float, Field(ge=0, le=1)]


class ImagingSpec(Spec):
    """How a camera's image comes about.

    width, height: pixels, 16 to 4096; fov_deg: horizontal field of view, degrees, inside (0, 180);
    fx (none: by fov_deg), fy (none: fx), cx, cy (none: the middle): pixels, as in OpenCV; k1, k2, p1, p2, k3:
    OpenCV's distortion; tilt_deg (down positive), roll_deg: on the pan axis, degrees; exposure: s that a row
    collects light (motion blur); readout: s from the first row to the last (rolling shutter); vignetting:
    part of the light that corners lose; shot_noise, read_noise: standard deviations at full light and at
    none, parts of full scale; gain: of light and noise, 0.01 to 100; gamma: levels are light to the power of
    1/gamma, 0.1 to 10; bits: of a level, 1 to 8.
    """

    width: Size = 640
    height: Size = 64
    fov_deg: Annotated[float, Field(gt=0, lt=180)] = 90.0
    fx: Positive | None = None
    fy: Positive | None = None
    cx: Finite | None = None
    cy: Finite | None = None
    k1: Finite = 0.0
    k2: Finite = 0.0
    p1: Finite = 0.0
    p2: Finite = 0.0
    k3: Finite = 0.0
    tilt_deg: Tilt = 0.0
    roll_deg: Annotated[float, Field(ge=-180, le=180)] = 0.0
    exposure: Seconds = 0.0
    readout: Seconds = 0.0
    vignetting: Fraction = 0.0
    shot_noise: Fraction = 0.0
    read_noise: Fraction = 0.0
    gain: Annotated[float, Field(ge=0.01, le=100)] = 1.0
    gamma: Annotated[float, Field(ge=0.1, le=10)] = 1.0
    bits: Annotated[int, Field(ge=1, le=8)] = 8

    @model_validator(mode="after")
    def _focal_lengths(self) -> Self:
        if self.fx is None and self.fy is not None:
            raise ValueError("fy needs fx")
        return self

    @model_validator(mode="after")
    def _can_be(self) -> Self:
        try:
            _ = self.lens
        except ScenarioError as error:
            raise ValueError(str(error)) from None
        return self

    @property
    def lens(self) -> Lens:
        """Intrinsics, distortion, tilt and roll; raises ScenarioError for a lens that cannot be."""
        pinhole = Lens.of_fov(self.width, self.height, radians(self.fov_deg))
        fx = self.fx or pinhole.fx
        return Lens(
            self.width,
            self.height,
            fx,
            self.fy or fx,
            pinhole.cx if self.cx is None else self.cx,
            pinhole.cy if self.cy is None else self.cy,
            self.k1,
            self.k2,
            self.p1,
            self.p2,
            self.k3,
            radians(self.tilt_deg),
            radians(self.roll_deg),
        )
