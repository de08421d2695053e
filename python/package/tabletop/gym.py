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
    name: str | None,
    goals: bool,
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
    reward: str | None = None,
    size: tuple[int, int] = (128, 128),
    camera: str = "head",
    smooth: bool = False,
    ticks_per_step: int = 3,
    max_steps: int = 400,
    record: Path | None = None,
) -> dict[str, Any]:
    options = dict(locals())
    options["goal"] = [goal] if isinstance(goal, str) else list(goal)
    options["allow_paths"] = [os.fspath(path) for path in allow_paths]
    del options["goals"]
    options["reward"] = reward or ("distance" if goals else "dense")
    if goals and options["reward"] != "distance":
        raise _tabletop.Error(f"goals: expected reward distance, which compute_reward computes, found {reward}")
    return options


def _fps(options: dict[str, Any]) -> int | float:
    """The steps in a second, of which each has a picture; a whole number where it is one, as some tools of Gymnasium need."""
    fps = 60 / options["ticks_per_step"]
    return int(fps) if fps.is_integer() else fps


def _check_reset_options(options: dict[str, Any] | None, *known: str) -> None:
    for name in options or {}:
        if name not in known:
            raise _tabletop.Error(f"options of reset: expected {', '.join(known) or 'none'}, found {name}")


def _check_render_mode(mode: str | None, known: Sequence[str]) -> None:
    if mode not in (None, *known):
        raise _tabletop.Error(f"render_mode: expected {' or '.join(known)}, found {mode}")


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
    reward: `dense` (the units by which the world has come nearer to its goal, and 1 if it is there), `sparse` (1 if it is there) or
        `distance` (the negative mean distance of the achieved from the desired places); with `goals` the last, which
        `compute_reward` computes.
    size, camera, smooth: of the pictures; `size` is columns x rows.
    ticks_per_step: 1/60 s each. max_steps: after which an episode is truncated.
    record: a folder in which each episode becomes a recording, `000000` and so on; the next `reset` or `close` finishes it.

    An episode ends when the world is at its goal; `info["is_success"]` says so, and `info["failures"]` what is not yet as it should be.
    `info["instruction"]` is what is to be done in this episode, where that is said: in `Instruction`.
    """

    metadata = {"render_modes": ["rgb_array", "human"], "render_fps": 20}

    def __init__(self, name: str | None = None, *, goals: bool = False, render_mode: str | None = None, **options: Any):
        options = _options(name, goals, **options)
        _check_render_mode(render_mode, self.metadata["render_modes"])
        self._env = _tabletop.Environment(options)
        self.metadata = {**self.metadata, "render_fps": _fps(options)}
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
        _check_reset_options(options)
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
        """Finishes the recording of the episode, and closes the window of render mode `human`."""
        self._env.finish_recording()
        if self._window is not None:
            import pygame

            pygame.display.quit()
            self._window = None

    def _observe(self) -> Any:
        picture = self._env.picture() if self._spaces.kind != "state" else (None, None)
        return self._spaces.of(self._env.state(), *picture)

    def _info(self, success: bool) -> dict[str, Any]:
        failures = [failure for failure, _, _ in self._env.verdicts() if failure]
        info = {"is_success": success, "failures": failures}
        instruction = self._env.instruction
        return info if instruction is None else info | {"instruction": instruction}

    def _show(self) -> None:
        try:
            import pygame
        except ImportError:
            raise _tabletop.Error("render mode human needs pygame: pip install pygame") from None
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

    metadata = {"render_modes": ["rgb_array"], "render_fps": 20, "autoreset_mode": AutoresetMode.NEXT_STEP}

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
        options = _options(name, goals, **options)
        _check_render_mode(render_mode, self.metadata["render_modes"])
        mode = AutoresetMode(autoreset_mode) if not isinstance(autoreset_mode, str) else _mode(autoreset_mode)
        single = _tabletop.Environment(options)
        self._spaces = _Spaces(single, options, goals)
        self._is_same_step = mode == AutoresetMode.SAME_STEP
        self._vector = _tabletop.Vector(options, num_envs, threads, mode.name.lower())
        self.num_envs = num_envs
        self.render_mode = render_mode
        self.metadata = {**self.metadata, "render_fps": _fps(options), "autoreset_mode": mode}
        self.single_observation_space = self._spaces.observation
        self.single_action_space = self._spaces.action
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.state_names = single.state_names
        self._copy = copy
        self._was_reset = np.zeros(num_envs, np.bool_)
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
        """Begins an episode in each, or in those that `options["reset_mask"]` names with a boolean each; the others stay as they are.

        A number seeds them with it and the numbers that follow.
        """
        mask = self._reset_mask(options)
        if isinstance(seed, (int, np.integer)):
            super().reset(seed=int(seed))
            seeds = [int(seed) + number for number in range(self.num_envs)]
        else:
            seeds = [None] * self.num_envs if seed is None else list(seed)
        if len(seeds) != self.num_envs:
            raise _tabletop.Error(f"expected {self.num_envs} seeds, found {len(seeds)}")
        numbers = np.flatnonzero(mask).tolist()
        if any(seeds[number] is None and not self._was_reset[number] for number in numbers):
            first = int(self.np_random.integers(2**62))
            seeds = [
                first + number if seed is None and not self._was_reset[number] else seed
                for number, seed in enumerate(seeds)
            ]
        self._vector.reset([(number, seeds[number]) for number in numbers])
        self._was_reset |= mask
        observation = self._observation(self._take())
        success = np.zeros(self.num_envs, np.bool_)
        return observation, _infos(mask, success, self._vector.failures()[0], self._vector.instructions()[0])

    def step(self, actions: np.ndarray) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Acts for a step in each: `actions` has a row for each."""
        self._vector.step(self._checked(actions, self.num_envs))
        return self._results(self._take(), np.arange(self.num_envs))

    def send(self, actions: np.ndarray, env_id: np.ndarray | None = None) -> None:
        """Lets these environments be stepped with a row each, and returns at once."""
        env_id = np.arange(self.num_envs) if env_id is None else np.asarray(env_id)
        self._vector.send(env_id.astype(np.int64), self._checked(actions, len(env_id)))

    def recv(self, count: int | None = None) -> tuple[Any, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Waits for so many environments, those that are ready first; their numbers are `info["env_id"]`. Without a count, for all."""
        env_id = self._vector.receive(self.num_envs if count is None else count)
        results = self._results(self._take(), env_id)
        observation, reward, success, truncation, info = (_rows(result, env_id) for result in results)
        return observation, reward, success, truncation, {"env_id": env_id, **info}

    def close_extras(self, **kwargs: Any) -> None:
        """Finishes the recordings of the episodes, and ends the threads."""
        if self._vector is not None:
            self._vector.finish_recordings()
        self._vector = None

    def render(self) -> tuple[np.ndarray, ...] | None:
        """The pictures of all."""
        return tuple(self._vector.pictures()) if self.render_mode == "rgb_array" else None

    def _reset_mask(self, options: dict[str, Any] | None) -> np.ndarray:
        _check_reset_options(options, "reset_mask")
        if not options:
            return np.ones(self.num_envs, np.bool_)
        mask = np.asarray(options["reset_mask"])
        if mask.dtype != np.bool_ or mask.shape != (self.num_envs,):
            raise _tabletop.Error(
                f"reset_mask: expected {self.num_envs} booleans, found numbers of type {mask.dtype} in the shape {mask.shape}"
            )
        if not mask.any():
            raise _tabletop.Error("reset_mask: expected at least one environment to be reset, found none")
        return mask

    def _checked(self, actions: np.ndarray, rows: int) -> np.ndarray:
        actions = np.ascontiguousarray(actions, dtype=np.float32)
        expected = (rows, *self.single_action_space.shape)
        if actions.shape != expected:
            raise _tabletop.Error(f"expected actions of the shape {expected}, found {actions.shape}")
        return actions

    def _take(self) -> dict[str, np.ndarray]:
        if self._copy:
            self._arrays = {name: np.empty_like(array) for name, array in self._arrays.items()}
        self._vector.copy_results({name: array.reshape(-1) for name, array in self._arrays.items()})
        return self._arrays

    def _observation(self, arrays: dict[str, np.ndarray], prefix: str = "") -> Any:
        parts = (arrays.get(prefix + name) for name in ("state", "rgb", "depth"))
        return self._spaces.of(*parts)

    def _results(self, arrays: dict[str, np.ndarray], env_id: np.ndarray) -> tuple[Any, ...]:
        success, truncation = arrays["success"], arrays["truncation"]
        failures, last_failures = self._vector.failures()
        instructions, last_instructions = self._vector.instructions()
        stepped = np.zeros(self.num_envs, np.bool_)
        stepped[env_id] = True
        info = _infos(stepped, success & (not self._is_same_step), failures, instructions)
        over = stepped & (success | truncation)
        if self._is_same_step and over.any():
            last = self._observation(arrays, "last_")
            info["final_obs"] = _objects({number: _rows(last, number) for number in np.flatnonzero(over)}, self.num_envs)
            info["final_info"] = _infos(over, success, last_failures, last_instructions)
            info["_final_obs"], info["_final_info"] = over, over.copy()
        return self._observation(arrays), arrays["reward"].astype(np.float64), success, truncation, info

    def __repr__(self) -> str:
        return f"<tabletop.TabletopVectorEnv of {self.num_envs}: {self._spaces.kind}>"


def _mode(name: str) -> AutoresetMode:
    try:
        return AutoresetMode[name.upper()]
    except KeyError:
        return AutoresetMode(name)


def _infos(
    mask: np.ndarray, success: np.ndarray, failures: list[list[str]], instructions: list[str]
) -> dict[str, np.ndarray]:
    """The infos of single environments as Gymnasium puts them together: each with a mask of those that have it."""

    def listed(of: list[Any]) -> np.ndarray:
        return _objects({number: of[number] for number in np.flatnonzero(mask)}, len(mask))

    infos = {"is_success": success & mask, "_is_success": mask.copy()}
    infos |= {"failures": listed(failures), "_failures": mask.copy()}
    if any(instructions):
        infos |= {"instruction": listed(instructions), "_instruction": mask.copy()}
    return infos


def _objects(of: dict[int, Any], count: int) -> np.ndarray:
    objects = np.full(count, None, object)
    for number, it in of.items():
        objects[number] = it
    return objects


def _rows(arrays: Any, numbers: np.ndarray | int) -> Any:
    if isinstance(arrays, dict):
        return {name: _rows(array, numbers) for name, array in arrays.items()}
    return arrays[numbers]


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
    """Makes the environments known to Gymnasium, as `import tabletop.gym` does: `gymnasium.make("tabletop/StackThree-v0")`."""
    for name in _tabletop.registered():
        id = f"tabletop/{name}-v0"
        if id not in gymnasium.registry:
            gymnasium.register(
                id,
                entry_point="tabletop.gym:TabletopEnv",
                vector_entry_point="tabletop.gym:TabletopVectorEnv",
                kwargs={"name": name},
            )
    if "tabletop/Joints-v0" not in gymnasium.registry:
        # Without Gymnasium's wrappers: LeRobot reads the task from the environment itself.
        gymnasium.register(
            "tabletop/Joints-v0",
            entry_point="tabletop.joint_env:JointEnv",
            disable_env_checker=True,
            order_enforce=False,
        )


register()
