"""Environments for Gymnasium: single ones, and many at once over threads."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import Any

import gymnasium
import numpy as np
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from . import _tabletop

Path = str | os.PathLike[str]

FARTHEST = 1000.0
"""The depth, in units, of a pixel that shows nothing."""


def _options(
    name: str | None = None,
    *,
    scenario: Path | None = None,
    setup: Path | None = None,
    goal: str | Iterable[str] = (),
    scatter: bool = True,
    allow_paths: Iterable[Path] = (),
    robot: Path | None = None,
    dynamic: bool = False,
    observation: str = "state",
    action: str = "joint_velocity",
    reward: str = "dense",
    size: tuple[int, int] = (128, 128),
    camera: str = "head",
    smooth: bool = False,
    ticks_per_step: int = 3,
    max_steps: int = 400,
) -> dict[str, Any]:
    options = dict(locals())
    options["goal"] = [goal] if isinstance(goal, str) else list(goal)
    options["allow_paths"] = [os.fspath(path) for path in allow_paths]
    return options


class _Spaces:
    """The spaces of an environment, and its observations."""

    def __init__(self, env: _tabletop.Environment, options: dict[str, Any], goals: bool):
        columns, rows = options["size"]
        picture = spaces.Box(0, 255, (rows, columns, 3), np.uint8)
        numbers = len(env.state_names)
        self.kind = options["observation"]
        self.goals = goals
        self.numbers, self.robot, self.checks = numbers, env.robot_numbers, env.checks
        if goals and self.kind != "state":
            raise _tabletop.Error(f"goals: expected observation state, found {self.kind}")
        if goals:
            self.numbers -= 6 * self.checks
            places = _numbers(3 * self.checks)
            self.observation = spaces.Dict(
                observation=_numbers(self.numbers), achieved_goal=places, desired_goal=places
            )
        elif self.kind == "state":
            self.observation = _numbers(numbers)
        elif self.kind == "rgb":
            self.observation = picture
        else:
            depth = spaces.Box(0, FARTHEST, (rows, columns), np.float32)
            self.observation = spaces.Dict(rgb=picture, depth=depth, state=_numbers(self.robot))
        self.action = spaces.Box(-1.0, 1.0, (env.action_length,), np.float32)
        self.shape = (rows, columns)

    def of(self, state: np.ndarray, rgb: np.ndarray | None, depth: np.ndarray | None) -> Any:
        """The observation of one environment, or of a batch."""
        if self.goals:
            places = state[..., self.numbers :].reshape(*state.shape[:-1], self.checks, 2, 3)
            rows = (*state.shape[:-1], 3 * self.checks)
            return {
                "observation": state[..., : self.numbers],
                "achieved_goal": places[..., 0, :].reshape(rows),
                "desired_goal": places[..., 1, :].reshape(rows),
            }
        if self.kind == "state":
            return state
        if self.kind == "rgb":
            return rgb
        return {
            "rgb": rgb,
            "depth": np.minimum(depth, np.float32(FARTHEST)),
            "state": state[..., : self.robot],
        }


def goal_reward(achieved_goal: np.ndarray, desired_goal: np.ndarray, info: Any) -> np.ndarray:
    """The negative mean distance of places that were achieved from those that were desired, in units, for one or for a batch."""
    gaps = (np.asarray(achieved_goal) - desired_goal).reshape(*np.shape(achieved_goal)[:-1], -1, 3)
    return -np.linalg.norm(gaps, axis=-1).mean(axis=-1)


def _numbers(count: int) -> spaces.Box:
    return spaces.Box(-np.inf, np.inf, (count,), np.float32)


class TabletopEnv(gymnasium.Env):
    """A task and a robot that acts.

    The task is one that comes with the program (`name`, see `tabletop.registered()`), a scenario's setup and the checks after
    its last act, or a task file and a `goal` of checks as they stand in scenarios: `'OnTopOf(object: "Red", of: "Green")'`.

    scatter: everything is at other places within reach of the robot in each episode.
    observation: `state` (numbers, see `state_names`), `rgb` (a picture), `rgbd` (a picture, depth in units, the robot's numbers).
    goals: the state as a dictionary of observation, achieved_goal and desired_goal, for hindsight.
    action: `joint_velocity`, `joint_position`, `end_effector_delta` or `pick_place`; all numbers are from -1 to 1.
    reward: `dense` (the units by which the world has come nearer to its goal, and 1 if it is there) or `sparse` (1 if it is there);
        with `goals` the negative mean distance of the achieved from the desired places, which `compute_reward` computes.
    size, camera, smooth: of the pictures; `size` is columns x rows.
    ticks_per_step: 1/60 s each. max_steps: after which an episode is truncated.

    An episode ends when the world is at its goal; `info["is_success"]` says so, and `info["failures"]` what is not yet as it should be.
    """

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 20}

    def __init__(self, name: str | None = None, *, goals: bool = False, render_mode: str | None = None, **options: Any):
        options = _options(name, **options)
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise _tabletop.Error(f"render_mode: expected rgb_array or human, found {render_mode}")
        self._env = _tabletop.Environment(options)
        self._spaces = _Spaces(self._env, options, goals)
        self.observation_space = self._spaces.observation
        self.action_space = self._spaces.action
        self.render_mode = render_mode
        self._options = options
        self._window = None
        self._is_reset = False
        if goals:
            # Checkers take any environment that has it for one with goals.
            self.compute_reward = goal_reward

    @property
    def state_names(self) -> list[str]:
        """The names of the numbers of a state, in order."""
        return self._env.state_names

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begins an episode: with a seed that of this seed, the same bits everywhere; otherwise the next one."""
        super().reset(seed=seed)
        if seed is None and not self._is_reset:
            seed = int(self.np_random.integers(2**63))
        self._is_reset = True
        self._env.reset(seed)
        if self.render_mode == "human":
            self._show()
        return self._observe(), self._info(False)

    def step(self, action: np.ndarray) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Acts for a step."""
        action = np.ascontiguousarray(action, dtype=np.float32)
        reward, success, truncated = self._env.step(action)
        observation = self._observe()
        if self._spaces.goals:
            reward = float(goal_reward(observation["achieved_goal"], observation["desired_goal"], {}))
        if self.render_mode == "human":
            self._show()
        return observation, reward, success, truncated, self._info(success)

    def snapshot(self) -> Any:
        """The present moment of this environment."""
        return self._env.snapshot()

    def restore(self, snapshot: Any) -> None:
        """Returns to a moment of this environment, bit for bit."""
        self._env.restore(snapshot)

    def render(self) -> np.ndarray | None:
        """The picture of the camera: rows x columns x 3 numbers from 0 to 255."""
        if self.render_mode == "human":
            return self._show()
        return self._env.picture()[0] if self.render_mode == "rgb_array" else None

    def close(self) -> None:
        """Closes the window of render mode `human`."""
        if self._window is not None:
            import pygame

            pygame.display.quit()
            self._window = None

    def _observe(self) -> Any:
        picture = self._env.picture() if self._spaces.kind != "state" else (None, None)
        return self._spaces.of(self._env.state(), *picture)

    def _info(self, success: bool) -> dict[str, Any]:
        failures = [failure for failure, _, _ in self._env.verdicts() if failure]
        return {"is_success": success, "failures": failures}

    def _show(self) -> None:
        try:
            import pygame
        except ImportError:
            raise _tabletop.Error("render mode human needs pygame: pip install tabletop[human]") from None
        picture = self._env.picture()[0]
        rows, columns, _ = picture.shape
        zoom = max(1, 640 // columns)
        if self._window is None:
            pygame.display.init()
            self._window = pygame.display.set_mode((columns * zoom, rows * zoom))
            pygame.display.set_caption("tabletop")
            self._clock = pygame.time.Clock()
        pygame.event.pump()
        surface = pygame.surfarray.make_surface(picture.swapaxes(0, 1))
        self._window.blit(pygame.transform.scale_by(surface, zoom), (0, 0))
        pygame.display.flip()
        self._clock.tick(self.metadata["render_fps"])

    def __repr__(self) -> str:
        what = self._options["name"] or self._options["scenario"] or self._options["setup"]
        return f"<tabletop.TabletopEnv {what}: {self._spaces.kind}, {self._options['action']}>"


class TabletopVectorEnv(VectorEnv):
    """Many environments of one task, each with its own world, stepped over threads; the bits are the same for any number of them.

    threads: 0 for one a core. autoreset_mode: `NEXT_STEP`, `SAME_STEP` or `DISABLED`.
    copy: whether each call returns new arrays; otherwise the next call overwrites them.

    `send` and `recv` step some of them while others are waited for, as in EnvPool.
    """

    metadata = {"render_modes": ["rgb_array"], "autoreset_mode": AutoresetMode.NEXT_STEP}

    def __init__(
        self,
        name: str | None = None,
        num_envs: int = 1,
        *,
        threads: int = 0,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        goals: bool = False,
        copy: bool = True,
        render_mode: str | None = None,
        **options: Any,
    ):
        options = _options(name, **options)
        mode = AutoresetMode(autoreset_mode) if not isinstance(autoreset_mode, str) else _mode(autoreset_mode)
        single = _tabletop.Environment(options)
        self._spaces = _Spaces(single, options, goals)
        self._is_same_step = mode == AutoresetMode.SAME_STEP
        self._vector = _tabletop.Vector(options, num_envs, threads, mode.name.lower())
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "autoreset_mode": mode}
        self.single_observation_space = self._spaces.observation
        self.single_action_space = self._spaces.action
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.state_names = single.state_names
        self._copy = copy
        self._is_reset = False
        rows, columns = self._spaces.shape
        numbers = len(self.state_names)
        arrays: dict[str, np.ndarray] = {"state": np.zeros((num_envs, numbers), np.float32)}
        if self._spaces.kind != "state":
            arrays["rgb"] = np.zeros((num_envs, rows, columns, 3), np.uint8)
        if self._spaces.kind == "rgbd":
            arrays["depth"] = np.zeros((num_envs, rows, columns), np.float32)
        if self._is_same_step:
            arrays |= {f"last_{name}": array.copy() for name, array in arrays.items()}
        arrays["reward"] = np.zeros(num_envs, np.float32)
        arrays["success"] = np.zeros(num_envs, np.bool_)
        arrays["truncation"] = np.zeros(num_envs, np.bool_)
        self._arrays = arrays

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begins an episode in each; a number seeds them with it and the numbers that follow."""
        super().reset(seed=seed if isinstance(seed, int) else None)
        if seed is None and not self._is_reset:
            seed = int(self.np_random.integers(2**62))
        if seed is None:
            seeds = [None] * self.num_envs
        elif isinstance(seed, (int, np.integer)):
            seeds = [int(seed) + number for number in range(self.num_envs)]
        else:
            seeds = list(seed)
            if len(seeds) != self.num_envs:
                raise _tabletop.Error(f"expected {self.num_envs} seeds, found {len(seeds)}")
        self._is_reset = True
        self._vector.reset(seeds)
        arrays = self._take()
        return self._observation(arrays), {}

    def step(self, actions: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Acts for a step in each: `actions` has a row for each."""
        self._vector.step(np.ascontiguousarray(actions, dtype=np.float32))
        return self._results(self._take(), None)

    def send(self, actions: np.ndarray, env_id: np.ndarray | None = None) -> None:
        """Lets these environments be stepped with a row each, and returns at once."""
        env_id = np.arange(self.num_envs) if env_id is None else np.asarray(env_id)
        self._vector.send(env_id.astype(np.int64), np.ascontiguousarray(actions, dtype=np.float32))

    def recv(self, count: int | None = None) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Waits for so many environments, those that are ready first; their numbers are `info["env_id"]`. Without a count, for all."""
        env_id = self._vector.receive(self.num_envs if count is None else count)
        return self._results(self._take(), env_id)

    def close_extras(self, **kwargs: Any) -> None:
        """Ends the threads."""
        self._vector = None

    def render(self) -> tuple[np.ndarray, ...] | None:
        """The pictures of all; only if they are observed."""
        return tuple(self._arrays["rgb"]) if self.render_mode == "rgb_array" and "rgb" in self._arrays else None

    def _take(self) -> dict[str, np.ndarray]:
        if self._copy:
            self._arrays = {name: np.empty_like(array) for name, array in self._arrays.items()}
        self._vector.copy_results({name: array.reshape(-1) for name, array in self._arrays.items()})
        return self._arrays

    def _observation(self, arrays: dict[str, np.ndarray], prefix: str = "") -> Any:
        parts = (arrays.get(prefix + name) for name in ("state", "rgb", "depth"))
        return self._spaces.of(*parts)

    def _results(self, arrays: dict[str, np.ndarray], env_id: np.ndarray | None) -> tuple[Any, ...]:
        observation = self._observation(arrays)
        reward, success, truncation = arrays["reward"], arrays["success"], arrays["truncation"]
        info: dict[str, Any] = {}
        if self._is_same_step and (success.any() or truncation.any()):
            over = success | truncation
            last = self._observation(arrays, "last_")
            info["final_obs"] = np.array(
                [_row(last, number) if over[number] else None for number in range(self.num_envs)] + [None], dtype=object
            )[:-1]
            info["_final_obs"] = over
            info["final_info"] = {"is_success": success.copy(), "_is_success": over.copy()}
            info["_final_info"] = over.copy()
        else:
            info["is_success"] = success.copy()
            info["_is_success"] = np.ones(self.num_envs, np.bool_)
        if self._spaces.goals:
            goals = self._observation(arrays, "last_") if self._is_same_step else observation
            reached = goal_reward(goals["achieved_goal"], goals["desired_goal"], {})
            present = goal_reward(observation["achieved_goal"], observation["desired_goal"], {})
            reward = np.where(success | truncation, reached, present).astype(np.float32)
        if env_id is None:
            return observation, reward, success, truncation, info
        info = {"env_id": env_id, "is_success": success[env_id]}
        return _rows(observation, env_id), reward[env_id], success[env_id], truncation[env_id], info

    def __repr__(self) -> str:
        return f"<tabletop.TabletopVectorEnv of {self.num_envs}: {self._spaces.kind}>"


def _mode(name: str) -> AutoresetMode:
    try:
        return AutoresetMode[name.upper()]
    except KeyError:
        return AutoresetMode(name)


def _row(observation: Any, number: int) -> Any:
    if isinstance(observation, dict):
        return {name: array[number] for name, array in observation.items()}
    return observation[number]


def _rows(observation: Any, numbers: np.ndarray) -> Any:
    if isinstance(observation, dict):
        return {name: array[numbers] for name, array in observation.items()}
    return observation[numbers]


def make(name: str, **options: Any) -> TabletopEnv:
    """An environment that comes with the program: `tabletop.make("StackThree", observation="rgb")`."""
    return TabletopEnv(name, **options)


def make_env(
    setup: Path | None = None, goal: str | Iterable[str] = (), *, scenario: Path | None = None, **options: Any
) -> TabletopEnv:
    """An environment of a task file and checks, or of a scenario, whose checks after the last act are the goal."""
    return TabletopEnv(setup=setup, goal=goal, scenario=scenario, **options)


def make_vec(name: str | None = None, num_envs: int = 1, threads: int = 0, **options: Any) -> TabletopVectorEnv:
    """Many environments over threads: `tabletop.make_vec("StackThree", num_envs=64)`."""
    name = name.removeprefix("tabletop/").removesuffix("-v0") if name else None
    return TabletopVectorEnv(name, num_envs, threads=threads, **options)


def register() -> None:
    """Makes the environments known to Gymnasium, which calls this: `gymnasium.make("tabletop/StackThree-v0")`."""
    for name in _tabletop.registered():
        id = f"tabletop/{name}-v0"
        if id not in gymnasium.registry:
            gymnasium.register(
                id,
                entry_point="tabletop.gym:TabletopEnv",
                vector_entry_point="tabletop.gym:TabletopVectorEnv",
                kwargs={"name": name},
            )
