"""Environments for policies that have learned from exported datasets."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces

from . import _tabletop
from .grip import PRESS, closes, kept
from .gym import _options

TICKS_PER_SECOND = 60

SPEED = 1.0
"""The speed of joints in an environment, in rad/s, and of grippers' openings, in units/s."""

OF_AN_OBJECT = 13
"""The numbers of an object in the state of an environment."""

OF_A_POSE = 7
"""Of these, its location in units and its rotation as a quaternion x, y, z, w."""

KINDS = {
    "pixels_agent_pos": ("pixels", "agent_pos"),
    "environment_state_agent_pos": ("environment_state", "agent_pos"),
}
"""The parts of an observation."""


class JointEnv(gymnasium.Env):
    """A task, with the observations and actions of `tabletop export --state robot --action joints`.

    task: one of `tabletop.registered()`, or a scenario's file, which ends with .ron. instruction: the task in words, where it does not say that itself.
    robot: a `robot.ron`; without it that of the task. scatter: everything is at other places within its reach in each episode.
    obs_type: `pixels_agent_pos` (the pictures of cameras, and the positions of all joints in rad and units) or `environment_state_agent_pos` (the poses of
        all objects in place of pictures).
    cameras: as `tabletop export --cameras` names them. size: of their pictures, columns x rows.
    fps: a divisor of 60. episode_length: the steps after which an episode is truncated.

    An action says where all joints are to be at its end. They go there evenly, and no faster than `SPEED`: a step takes 1/fps s, and longer where that is not
    enough. Fingers that close feel whether there is a thing a little farther between them, and hold it, or return; then they keep it until they are to open farther than
    that.
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
        if fps <= 0 or TICKS_PER_SECOND % fps:
            raise _tabletop.Error(f"fps: expected a divisor of {TICKS_PER_SECOND}, found {fps}")
        place = {"scenario": task, "name": None} if task.endswith(".ron") else {"name": task}
        # As smooth as the pictures of recordings; a step is as many of theirs as it takes.
        one_tick = {"action": "joint_position", "smooth": True, "ticks_per_step": 1, "max_steps": 2**53}
        options = _options(goals=False, robot=robot, scatter=scatter, **place, **one_tick)
        self._env = _tabletop.Environment(options)
        self._env.reset(0)
        joints = self._env.joints()
        self.joint_names: list[str] = joints["name"]
        self._low, self._high = joints["low"], joints["high"]
        self._driven = np.array([self.joint_names.index(name) for name in self._env.driven_joints])
        holds = [place for place, name in enumerate(self._env.state_names) if name.endswith(".holds")]
        self._grippers = list(zip(self._driven[-len(holds) :], holds))
        self._parts = KINDS[obs_type]
        self._cameras, self._size = list(cameras), tuple(size)
        self._ticks = TICKS_PER_SECOND // fps
        self._steps, self._max_episode_steps = 0, episode_length
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
        self._steps = 0
        self._env.reset(seed)
        self.task_description = self._env.instruction or self._instruction
        return self._observe(), {"is_success": False}

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Moves the joints to where an action says that they are to be."""
        there = np.clip(np.asarray(action, np.float64), self._low, self._high)
        here, holding = self._env.joints()["position"], self._holding()
        feel = there.copy()
        for gripper, holds in self._grippers:
            if holds in holding:
                there[gripper] = feel[gripper] = kept(there[gripper], here[gripper])
            elif closes(there[gripper], here[gripper]):
                feel[gripper] -= PRESS
        reward, success = self._go(there, self._ticks)
        if not success and (feel != there).any():
            felt, success = self._go(feel, 1)
            reward += felt
            if not success and self._holding() == holding:
                back, success = self._go(there, 1)
                reward += back
        self._steps += 1
        truncated = not success and self._steps >= self._max_episode_steps
        return self._observe(), reward, success, truncated, {"is_success": success}

    def render(self) -> np.ndarray | None:
        """The picture of the first camera, of 320 x 240."""
        return self._env.shoot(self._cameras[:1], (320, 240))[0][1]

    def _holding(self) -> set[int]:
        """The places in the state of the grippers that hold something."""
        state = self._env.state()
        return {holds for _, holds in self._grippers if state[holds]}

    def _go(self, there: np.ndarray, ticks: int) -> tuple[float, bool]:
        """Moves the joints there, in so many ticks or more. Returns the reward, and whether the task is done."""
        here = self._env.joints()["position"]
        way = np.clip(there, self._low, self._high) - here
        farthest = np.abs(way[self._driven]).max()
        ticks = max(ticks, math.ceil(farthest / SPEED * TICKS_PER_SECOND - 1e-6))
        reward, success = 0.0, False
        for tick in range(1, ticks + 1):
            gained, success, _ = self._env.step(self._shares(here + way * (tick / ticks)))
            reward += gained
            if success:
                break
        return reward, success

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
