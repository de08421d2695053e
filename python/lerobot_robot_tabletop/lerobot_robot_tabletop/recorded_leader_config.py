"""`--teleop.type=tabletop_recording`."""

from __future__ import annotations

from dataclasses import dataclass

from lerobot.teleoperators.config import TeleoperatorConfig


@TeleoperatorConfig.register_subclass("tabletop_recording")
@dataclass(kw_only=True)
class TabletopRecordingConfig(TeleoperatorConfig):
    """A leader that does what the robot of a recording did.

    recording: its folder. fps: of the program that asks it, a divisor of 60.
    """

    recording: str = ""
    fps: int = 30
