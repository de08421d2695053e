"""The tabletop simulator: a table with objects, the invisible hands of a demonstrator, and a robot that learns from them.

A unit of length is 10 cm; masses are in kg, times in s, angles in rad. The origin is the centre of the table's top, X to the
right, Y away from the robot, Z up. Rotations are quaternions x, y, z, w. A tick is 1/60 s.

    world = tabletop.World("tablesetup/default.xml")
    world.grasp("RedBlock")
    world.glide(to=(-2, 0, 4), seconds=1)
    world.release()

    env = tabletop.make("StackThree", observation="rgb")      # or, after `import tabletop.gym`, gymnasium.make("tabletop/StackThree-v0")
    many = tabletop.make_vec("StackThree", num_envs=64)

`python -m tabletop` is the command line.
"""

import importlib

from ._tabletop import Error, Policy, Snapshot, registered, version
from .recording import Recording, explain, imitate, multiply, teach, tell
from .world import Limb, Objects, World

__version__ = version()

__all__ = [
    "Error",
    "Limb",
    "Objects",
    "Policy",
    "Recording",
    "Snapshot",
    "TabletopEnv",
    "TabletopVectorEnv",
    "World",
    "explain",
    "imitate",
    "make",
    "make_env",
    "make_vec",
    "multiply",
    "registered",
    "teach",
    "tell",
]

_OF_GYMNASIUM = {"TabletopEnv", "TabletopVectorEnv", "make", "make_env", "make_vec"}


def __getattr__(name):
    # Gymnasium is needed only by those who use environments.
    if name == "gym" or name in _OF_GYMNASIUM:
        gym = importlib.import_module(".gym", __name__)
        return gym if name == "gym" else getattr(gym, name)
    raise AttributeError(f"module 'tabletop' has no attribute {name!r}")


def __dir__():
    return sorted(__all__)
