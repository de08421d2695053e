"""Environments for policies that have learned from exported datasets."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from . import _tabletop
from .gym import _options

TICKS_PER_SECOND = 60

OF_AN_OBJECT = 13
"""The numbers of an object in the state of an environment."""

OF_A_POSE = 7
"""Of these, its location in units and its rotation as a quaternion x, y, z, w."""

KINDS = {
    "pixels_agent_pos": ("pixels", "agent_pos"),
    "environment_state_agent_pos": ("environment_state", "agent_pos"),
}
"""The parts of an observation."""


def ticks_per_step(fps: int) -> int:
    """The ticks of a step, of which there are so many a second."""
    if fps <= 0 or TICKS_PER_SECOND % fps:
        raise _tabletop.Error(f"fps: expected a divisor of {TICKS_PER_SECOND}, found {fps}")
    return TICKS_PER_SECOND // fps


class JointEnv(gymnasium.Env):
    """A task, with the observations and actions of `tabletop export --state robot --action joints`.

    task: one of `tabletop.registered()`, or a scenario's file, which ends with .ron. instruction: the task in words, where it does not say that itself.
    robot: a `robot.ron`; without it that of the task. scatter: everything is at other places within its reach in each episode.
    obs_type: `pixels_agent_pos` (the pictures of cameras, and the positions of all joints in rad and units) or `environment_state_agent_pos` (the poses of
        all objects in place of pictures).
    cameras: as `tabletop export --cameras` names them. size: of their pictures, columns x rows.
    fps: a divisor of 60. episode_length: the steps after which an episode is truncated.

    An action says where all joints are to be at its end, after 1/fps s. They go there evenly, as far as their speeds allow. Fingers hold what they close on until
    they are to open.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}

    def __init__(
        self,
        task: str,
        *,
        instruction: str = "",
        robot: str | None = None,
        scatter: bool = True,
        obs_type: str = "pixels_agent_pos",
        cameras: Sequence[str] = ("head",),
        size: tuple[int, int] = (96, 96),
        fps: int = 10,
        episode_length: int = 100,
        render_mode: str | None = "rgb_array",
    ):
        if obs_type not in KINDS:
            raise _tabletop.Error(f"obs_type: expected {' or '.join(KINDS)}, found {obs_type}")
        place = {"scenario": task, "name": None} if task.endswith(".ron") else {"name": task}
        # As smooth as the pictures of recordings.
        step = {"action": "joint_position", "smooth": True, "ticks_per_step": ticks_per_step(fps), "max_steps": episode_length}
        options = _options(goals=False, robot=robot, scatter=scatter, **place, **step)
        self._env = _tabletop.Environment(options)
        self._env.reset(0)
        joints = self._env.joints()
        self.joint_names: list[str] = joints["name"]
        self._low, self._high = joints["low"], joints["high"]
        self._driven = np.array([self.joint_names.index(name) for name in self._env.driven_joints])
        self._parts = KINDS[obs_type]
        self._cameras, self._size = list(cameras), tuple(size)
        self._max_episode_steps = episode_length
        self.task, self.task_description, self._instruction = task, instruction, instruction
        self.metadata = {**self.metadata, "render_fps": fps}
        self.render_mode = render_mode
        self.action_space = spaces.Box(self._low.astype(np.float32), self._high.astype(np.float32))
        self.observation_space = _space(self._observe())
        self._is_reset = False

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode: with a seed that of this seed, the same bits everywhere; otherwise the next one."""
        super().reset(seed=seed)
        if seed is None and not self._is_reset:
            seed = int(self.np_random.integers(2**63))
        self._is_reset = True
        self._env.reset(seed)
        self.task_description = self._env.instruction or self._instruction
        return self._observe(), {"is_success": False}

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Moves the joints to where an action says that they are to be."""
        reward, success, truncated = self._env.step(self._shares(np.asarray(action, np.float64)))
        return self._observe(), reward, success, truncated, {"is_success": success}

    def render(self) -> np.ndarray | None:
        """The picture of the first camera, of 320 x 240."""
        return self._env.shoot(self._cameras[:1], (320, 240))[0][1]

    def _shares(self, positions: np.ndarray) -> np.ndarray:
        """Positions of all joints as the numbers, from -1 to 1, of those that an environment moves."""
        shares = 2 * (positions - self._low) / (self._high - self._low) - 1
        return shares[self._driven].astype(np.float32)

    def _observe(self) -> dict[str, Any]:
        state = self._env.state()
        seen: dict[str, Any] = {"agent_pos": state[: len(self.joint_names)]}
        if "pixels" in self._parts:
            seen["pixels"] = dict(self._env.shoot(self._cameras, self._size))
        if "environment_state" in self._parts:
            count = OF_AN_OBJECT * len(self._env.objects)
            objects = state[self._env.robot_numbers :][:count].reshape(-1, OF_AN_OBJECT)
            seen["environment_state"] = objects[:, :OF_A_POSE].ravel()
        return seen


def _space(seen: Any) -> spaces.Space:
    """The space of observations like this one."""
    if isinstance(seen, dict):
        return spaces.Dict({name: _space(part) for name, part in seen.items()})
    if seen.dtype == np.uint8:
        return spaces.Box(0, 255, seen.shape, np.uint8)
    return spaces.Box(-np.inf, np.inf, seen.shape, np.float32)
