"""The far end of the bus: choppers, motors, shafts and the world they move; or a recorded or ideal robot."""

from hilbed.plant.kinematic_spec import KinematicSpec
from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.specs import SimulatedSpec

PlantSpec = SimulatedSpec | KinematicSpec | RecordedSpec

__all__ = ["KinematicSpec", "PlantSpec", "RecordedSpec", "SimulatedSpec"]
