"""`--robot.type=tabletop`."""

from __future__ import annotations

from dataclasses import dataclass

from lerobot.robots.config import RobotConfig


@RobotConfig.register_subclass("tabletop")
@dataclass(kw_only=True)
class TabletopRobotConfig(RobotConfig):
    """A simulated robot, and the table before it.

    robot: a `robot.ron`; without it Baxter.
    setup, recording: a task file, or a recording with whose beginning the table begins; at most one of them.
    fps: of the program that drives it, a divisor of 60: an action takes 1/fps s of simulated time, however long the program takes.
    degrees: joints and actions are called `shoulder_pan.pos`, in degrees, and openings go from 0, closed, to 100, as those of LeRobot's own arms, so that their leaders drive it.
        Otherwise they are those of `tabletop export`: `shoulder_pan` in rad, openings in units.
    views: cameras, as `tabletop export --cameras` names them.
    record: a folder that becomes a recording of what it does.
    """

    robot: str | None = None
    setup: str | None = None
    recording: str | None = None
    fps: int = 30
    degrees: bool = False
    views: str = "head"
    view_width: int = 96
    view_height: int = 96
    record: str | None = None
