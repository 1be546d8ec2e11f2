"""For tests of a detector with pytest: rendered frames with truth, degradations, one assertion.

The fixtures come by themselves where hilbed is installed; see hilbed.testing.plugin.
"""

from hilbed.testing.assertions import assert_azimuths

__all__ = ["assert_azimuths"]
