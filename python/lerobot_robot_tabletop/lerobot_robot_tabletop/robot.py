"""A simulated robot that LeRobot's programs drive."""

from __future__ import annotations

from contextlib import ExitStack
from typing import Any

import numpy as np
from lerobot.robots.robot import Robot

import tabletop
from tabletop.cameras import camera_list, camera_name
from tabletop.joint_env import TICKS_PER_SECOND, ticks_per_step

from .robot_config import TabletopRobotConfig


class TabletopRobot(Robot):
    """A robot at a table. Time passes for it only while it carries out an action."""

    config_class = TabletopRobotConfig
    name = "tabletop"

    def __init__(self, config: TabletopRobotConfig):
        super().__init__(config)
        self.config = config
        self._ticks = ticks_per_step(config.fps)
        # LeRobot counts them.
        self.cameras = {camera_name(camera): camera for camera in camera_list(config.views)}
        self.world: tabletop.World | None = None
        self._recording = ExitStack()
        robot = self._new_world().robot
        self._joints = robot.joint_names
        self._grippers = {limb.gripper for limb in robot.limbs.values()}
        self._widest = dict(zip(self._joints, robot.limits[:, 1].tolist()))

    def _new_world(self) -> tabletop.World:
        config = self.config
        return tabletop.World(config.setup, recording=config.recording, robot=config.robot)

    @property
    def observation_features(self) -> dict[str, Any]:
        shape = (self.config.view_height, self.config.view_width, 3)
        return self.action_features | dict.fromkeys(self.cameras, shape)

    @property
    def action_features(self) -> dict[str, type]:
        return {self._key(joint): float for joint in self._joints}

    @property
    def is_connected(self) -> bool:
        return self.world is not None

    @property
    def is_calibrated(self) -> bool:
        return True

    def calibrate(self) -> None:
        pass

    def configure(self) -> None:
        pass

    def connect(self, calibrate: bool = True) -> None:
        self.world = self._new_world()
        if self.config.record:
            self._recording.enter_context(self.world.record(self.config.record))

    def disconnect(self) -> None:
        self._recording.close()
        self.world = None

    def get_observation(self) -> dict[str, Any]:
        world = self._connected()
        seen: dict[str, Any] = {
            self._key(joint): position / self._unit(joint) for joint, position in world.robot.joints.items()
        }
        size = (self.config.view_width, self.config.view_height)
        for name, camera in self.cameras.items():
            seen[name] = np.asarray(world.picture(camera, size))
        return seen

    def send_action(self, action: dict[str, Any]) -> dict[str, Any]:
        world = self._connected()
        there = {joint: float(action[self._key(joint)]) * self._unit(joint) for joint in self._joints}
        for left in range(self._ticks, 0, -1):
            here = world.robot.joints
            speeds = {joint: (there[joint] - here[joint]) * TICKS_PER_SECOND / left for joint in self._joints}
            world.robot.drive(speeds, "velocity")
            world.step()
        return action

    def _connected(self) -> tabletop.World:
        if self.world is None:
            raise ConnectionError(f"{self} is not connected")
        return self.world

    def _key(self, joint: str) -> str:
        return f"{joint}.pos" if self.config.degrees else joint

    def _unit(self, joint: str) -> float:
        """The rad or units of a 1 in an action."""
        if not self.config.degrees:
            return 1.0
        return self._widest[joint] / 100 if joint in self._grippers else np.pi / 180
