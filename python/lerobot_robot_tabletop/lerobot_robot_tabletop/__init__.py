"""tabletop for LeRobot's programs, which import this package by its name: `--env.type=tabletop`, `--robot.type=tabletop`, `--teleop.type=tabletop_recording`."""

from .env_config import TabletopEnvConfig
from .recorded_leader import TabletopRecording
from .recorded_leader_config import TabletopRecordingConfig
from .robot import TabletopRobot
from .robot_config import TabletopRobotConfig

__all__ = [
    "TabletopEnvConfig",
    "TabletopRecording",
    "TabletopRecordingConfig",
    "TabletopRobot",
    "TabletopRobotConfig",
]
