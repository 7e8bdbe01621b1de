"""Links and joints of articulated objects, from how tracked points move.

`perceive` tells what a recording shows. `Learner` pushes an object to find that out, and learns which
pushes tell most; `World` is a simulated table to try it on, and `Supervisor` knows the truth.
"""

from . import io
from ._native import (DIRECTIONS_DEG, HAS_WORLD, MAX_FEATURES, MAX_JOINTS, MAX_LINKS, POLICIES,
                      SETTLING_FRAMES, VERSION, Frame)
from .learner import Decision, Learner, Push, Update, Usage
from .model import Body, Joint, Model, Pair
from .perception import Perception, perceive
from .policy import Outcome, Policy, View
from .tracks import Tracks
from .world import (PushResult, Supervisor, TrialResult, Verdict, World, run_trial, trial_seed)

try:  # where Gymnasium is: gymnasium.make("grrl/Discover-v0")
    from . import envs
except ImportError:
    pass
else:
    envs.register()

__version__ = VERSION

__all__ = [
    "Body", "DIRECTIONS_DEG", "Decision", "Frame", "HAS_WORLD", "Joint", "Learner", "MAX_FEATURES",
    "MAX_JOINTS", "MAX_LINKS", "Model", "Outcome", "POLICIES", "Pair", "Perception", "Policy", "Push",
    "PushResult", "SETTLING_FRAMES", "Supervisor", "Tracks", "TrialResult", "Update", "Usage",
    "Verdict", "View", "World", "io", "perceive", "run_trial", "trial_seed",
]
