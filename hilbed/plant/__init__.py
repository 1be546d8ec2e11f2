"""The far end of the bus: choppers, motors, shafts and the world they move; or a recorded robot."""

from hilbed.plant.recorded_spec import RecordedSpec
from hilbed.plant.specs import SimulatedSpec

PlantSpec = SimulatedSpec | RecordedSpec

__all__ = ["PlantSpec", "RecordedSpec", "SimulatedSpec"]
