"""A recording that leads a robot, in place of a leader arm."""

from __future__ import annotations

from typing import Any

import numpy as np
from lerobot.teleoperators.teleoperator import Teleoperator

import tabletop
from tabletop.joint_env import TICKS_PER_SECOND

from .recorded_leader_config import TabletopRecordingConfig


class TabletopRecording(Teleoperator):
    """The joints of a recording's robot, a step further each time it is asked; in the end they stay where they are."""

    config_class = TabletopRecordingConfig
    name = "tabletop_recording"

    def __init__(self, config: TabletopRecordingConfig):
        super().__init__(config)
        self.config = config
        self._positions: dict[str, tuple[np.ndarray, np.ndarray]] = {}
        joints = tabletop.Recording(config.recording).joints()
        names = np.array(joints["joint"])
        for name in dict.fromkeys(joints["joint"]):
            rows = names == name
            self._positions[name] = (np.asarray(joints["tick"])[rows], np.asarray(joints["position"])[rows])
        self._first = min(int(ticks[0]) for ticks, _ in self._positions.values())
        self._asked: int | None = None

    @property
    def action_features(self) -> dict[str, type]:
        return dict.fromkeys(self._positions, float)

    @property
    def feedback_features(self) -> dict[str, type]:
        return {}

    @property
    def is_connected(self) -> bool:
        return self._asked is not None

    @property
    def is_calibrated(self) -> bool:
        return True

    def calibrate(self) -> None:
        pass

    def configure(self) -> None:
        pass

    def connect(self, calibrate: bool = True) -> None:
        self._asked = 0

    def disconnect(self) -> None:
        self._asked = None

    def get_action(self) -> dict[str, Any]:
        if self._asked is None:
            raise ConnectionError(f"{self} is not connected")
        self._asked += 1
        tick = self._first + self._asked * TICKS_PER_SECOND // self.config.fps
        return {name: self._at(name, tick) for name in self._positions}

    def send_feedback(self, feedback: dict[str, Any]) -> None:
        pass

    def _at(self, joint: str, tick: int) -> float:
        """The position of a joint at the end of a tick: that of the last row until then."""
        ticks, positions = self._positions[joint]
        row = np.searchsorted(ticks, tick, side="right") - 1
        return float(positions[max(row, 0)])
