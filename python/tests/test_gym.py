"""Environments."""

import hashlib
import multiprocessing
import os
import subprocess
import sys
import warnings

import numpy as np
import pytest

import tabletop

gymnasium = pytest.importorskip("gymnasium")
from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode, SyncVectorEnv  # noqa: E402

import tabletop.gym  # noqa: E402

ACTIONS = ["joint_velocity", "joint_position", "end_effector_delta", "pick_place"]


@pytest.mark.parametrize("name", tabletop.registered())
def test_gymnasium_finds_no_fault(name):
    env = gymnasium.make(f"tabletop/{name}-v0").unwrapped
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warnings.filterwarnings("ignore", message=".*(infinity|render modes|Box observation space).*")
        check_env(env, skip_render_check=True)


@pytest.mark.parametrize("observation", ["state", "rgb", "rgbd"])
@pytest.mark.parametrize("action", ACTIONS)
def test_every_space_is_kept(observation, action):
    env = tabletop.make("StackTwoBlocks", observation=observation, action=action, size=(40, 30), render_mode="rgb_array")
    first, _ = env.reset(seed=1)
    assert first in env.observation_space
    env.action_space.seed(0)
    for _ in range(3):
        seen, reward, done, cut, info = env.step(env.action_space.sample())
        assert seen in env.observation_space
        assert isinstance(reward, float) and not done and not cut and info["failures"]
    assert env.render().shape == (30, 40, 3)
    assert len(env.state_names) == len(tabletop.make("StackTwoBlocks", action=action).reset()[0])


def test_goals_are_for_hindsight():
    env = tabletop.make("StackThree", goals=True)
    env.reset(seed=0)
    env.action_space.seed(0)
    seen, reward, *_ = env.step(env.action_space.sample())
    assert seen in env.observation_space
    again = env.compute_reward(seen["achieved_goal"], seen["desired_goal"], {})
    assert reward == pytest.approx(float(again))
    batch = env.compute_reward(np.stack([seen["achieved_goal"]] * 3), np.stack([seen["desired_goal"]] * 3), [{}] * 3)
    assert batch.shape == (3,)


def test_an_environment_of_ones_own():
    env = tabletop.make_env(
        "shipped:tablesetup/default.xml",
        'OnTopOf(object: "RedBlock", of: "GreenBlock")',
        action="pick_place",
        scatter=False,
    )
    env.reset(seed=0)
    _, reward, done, _, info = env.step(np.array([0.2, 0, -0.2, 0, 0.25], np.float32))
    assert done and info["is_success"] and reward > 4 and info["failures"] == []
    with pytest.raises(tabletop.Error, match="expected state, rgb, rgbd, found touch"):
        tabletop.make("Hanoi", observation="touch")
    with pytest.raises(tabletop.Error, match="no environment Nothing"):
        tabletop.make("Nothing")
    with pytest.raises(tabletop.Error, match="an action of 3 numbers, expected 5"):
        env.step(np.zeros(3))


def test_an_instruction_is_drawn_and_followed():
    env = gymnasium.make("tabletop/Instruction-v0", action="pick_place", goals=True, disable_env_checker=True)
    said, followed = set(), 0
    for seed in range(8):
        seen, info = env.reset(seed=seed)
        instruction = info["instruction"]
        assert env.reset(seed=seed)[1]["instruction"] == instruction
        said.add(instruction)
        done = False
        for _ in range(12):
            achieved, desired = (seen[name].reshape(-1, 3) for name in ("achieved_goal", "desired_goal"))
            moved = np.flatnonzero(np.linalg.norm(achieved - desired, axis=1) > 0.05)
            if done or not len(moved):
                break
            # What others are put on comes first.
            next = min(moved, key=lambda number: desired[number, 2])
            places = [achieved[next, 0] / 10, achieved[next, 1] / 6, desired[next, 0] / 10, desired[next, 1] / 6, 0]
            seen, _, done, _, info = env.step(np.array(places, np.float32))
            assert info["instruction"] == instruction
        followed += done
    assert len(said) > 4 and followed >= 7, (said, followed)
    _, info = tabletop.make("StackThree").reset(seed=0)
    assert "instruction" not in info


def rollout(seed, steps=30, **options):
    env = tabletop.make("StackThree", observation="rgbd", size=(32, 24), **options)
    digest = hashlib.sha256()
    seen, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    for _ in range(steps):
        for part in seen.values():
            digest.update(part.tobytes())
        seen, reward, *_ = env.step(env.action_space.sample())
        digest.update(np.float32(reward).tobytes())
    return digest.hexdigest()


def test_the_same_rollout_twice():
    assert rollout(5) == rollout(5) != rollout(6)


def test_a_rollout_in_other_processes():
    here = rollout(5)
    for method in "fork", "spawn":
        with multiprocessing.get_context(method).Pool(1) as pool:
            assert pool.apply(rollout, (5,)) == here, method


def test_a_moment_within_a_rollout():
    env = tabletop.make("StackThree")
    env.reset(seed=3)
    env.action_space.seed(3)
    actions = [env.action_space.sample() for _ in range(20)]
    moment = env.snapshot()

    def on():
        return [(env.step(action)[0].tobytes(), env.step(action)[1]) for action in actions]

    once = on()
    env.restore(moment)
    assert on() == once


@pytest.mark.parametrize("mode", ["next_step", "same_step"])
def test_vectors_are_the_same_over_any_number_of_threads(mode):
    def bits(threads):
        many = tabletop.make_vec(
            "StackThree", 6, threads=threads, observation="rgb", size=(32, 24), max_steps=5, autoreset_mode=mode
        )
        digest = hashlib.sha256()
        seen, _ = many.reset(seed=9)
        many.action_space.seed(0)
        cut = 0
        for _ in range(14):
            digest.update(seen.tobytes())
            seen, reward, done, truncated, info = many.step(many.action_space.sample())
            assert seen in many.observation_space
            digest.update(reward.tobytes() + truncated.tobytes())
            cut += truncated.sum()
            if mode == "same_step" and truncated.any():
                assert info["final_obs"][0].shape == (24, 32, 3)
        assert cut == 12
        return digest.hexdigest()

    assert bits(1) == bits(2) == bits(8)


def test_a_row_of_a_vector_is_the_single_environment():
    many = tabletop.make_vec("tabletop/StackThree-v0", 3)
    one = tabletop.make("StackThree")
    seen, _ = many.reset(seed=[4, 5, 6])
    alone, _ = one.reset(seed=5)
    actions = np.full((3, 16), 0.25, np.float32)
    for _ in range(10):
        np.testing.assert_array_equal(seen[1], alone)
        seen, reward, *_ = many.step(actions)
        alone, single, *_ = one.step(actions[1])
        assert reward[1] == np.float32(single)


MODES = ["next_step", "same_step", "disabled"]


def pair(mode, count=3, name="StackThree", **options):
    """Many environments of this package, and as many of Gymnasium's over single ones."""
    ours = tabletop.make_vec(name, count, autoreset_mode=mode, **options)
    make = lambda: tabletop.make(name, **options)  # noqa: E731
    return ours, SyncVectorEnv([make] * count, autoreset_mode=AutoresetMode[mode.upper()])


def assert_same(ours, theirs, where):
    assert type(ours) is type(theirs), where
    if isinstance(ours, dict):
        assert ours.keys() == theirs.keys(), where
        for name in ours:
            assert_same(ours[name], theirs[name], f"{where}: {name}")
    elif isinstance(ours, (tuple, list)):
        assert len(ours) == len(theirs), where
        for number, (our, their) in enumerate(zip(ours, theirs)):
            assert_same(our, their, f"{where}[{number}]")
    elif isinstance(ours, np.ndarray) and ours.dtype == object:
        assert_same(list(ours), list(theirs), where)
    elif isinstance(ours, np.ndarray):
        assert ours.dtype == theirs.dtype, where
        np.testing.assert_array_equal(ours, theirs, where)
    else:
        assert ours == theirs, where


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize(
    "options",
    [
        {},
        {"goals": True},
        {"observation": "rgb"},
        {"observation": "rgbd", "reward": "sparse"},
        {"action": "pick_place"},
        {"name": "Instruction", "action": "pick_place"},
    ],
    ids=str,
)
def test_many_are_what_gymnasium_makes_of_single_ones(mode, options):
    ours, theirs = pair(mode, size=(16, 12), max_steps=3, render_mode="rgb_array", **options)
    for name in "observation_space", "action_space", "single_observation_space", "single_action_space":
        assert getattr(ours, name) == getattr(theirs, name)
    # Many have no window.
    assert ours.metadata == {**theirs.metadata, "render_modes": ["rgb_array"]} and ours.render_mode == theirs.render_mode
    assert_same(ours.reset(seed=4), theirs.reset(seed=4), "reset")
    ours.action_space.seed(0)
    reset = 0
    for step in range(9):
        actions = ours.action_space.sample()
        results = ours.step(actions)
        assert_same(results, theirs.step(actions), f"step {step}")
        assert_same(ours.render(), theirs.render(), f"picture {step}")
        over = results[2] | results[3]
        masks = []
        if mode == "disabled" and over.any():
            masks.append(over)
        if step in (1, 4, 7):
            masks.append(np.array([True, False, step == 4]))
        for mask in masks:
            reset += 1
            seeds = [step, None, 7]
            both = [many.reset(seed=seeds, options={"reset_mask": mask.copy()}) for many in (ours, theirs)]
            assert_same(*both, f"reset {step}")
    assert reset >= 3


def test_only_the_masked_environments_are_reset():
    many = tabletop.make_vec("StackThree", 3, autoreset_mode="disabled", max_steps=50)
    many.reset(seed=1)
    for _ in range(3):
        seen, *_ = many.step(np.full(many.action_space.shape, 0.3, np.float32))
    after, infos = many.reset(options={"reset_mask": np.array([True, False, False])})
    assert [bool((seen[row] != after[row]).any()) for row in range(3)] == [True, False, False]
    assert infos["_is_success"].tolist() == [True, False, False]
    for mask, words in [
        (np.array([1, 0, 0]), "expected 3 booleans, found numbers of type int64"),
        (np.array([True, False]), "expected 3 booleans"),
        (np.zeros(3, bool), "at least one"),
    ]:
        with pytest.raises(tabletop.Error, match=f"reset_mask: .*{words}"):
            many.reset(options={"reset_mask": mask})
    with pytest.raises(tabletop.Error, match="expected reset_mask, found mask"):
        many.reset(options={"mask": np.ones(3, bool)})
    with pytest.raises(tabletop.Error, match="expected none, found reset_mask"):
        tabletop.make("StackThree").reset(options={"reset_mask": np.ones(1, bool)})


def test_environments_without_seeds_begin_differently():
    many = tabletop.make_vec("StackThree", 3)
    mask = np.array([True, True, False])
    first, _ = many.reset(options={"reset_mask": mask})
    second, _ = many.reset(options={"reset_mask": ~mask})
    rows = [first[0], first[1], second[2]]
    assert all((rows[one] != rows[other]).any() for one, other in [(0, 1), (0, 2), (1, 2)])


def test_what_is_no_action_is_refused():
    one = tabletop.make("StackThree")
    with pytest.raises(tabletop.Error, match="no episode has begun; reset it first"):
        one.step(np.zeros(16))
    one.reset(seed=0)
    action = np.zeros(16)
    action[5] = np.nan
    with pytest.raises(tabletop.Error, match="number 5 of the action, from 0, is NaN"):
        one.step(action)
    action[5] = np.inf
    one.step(action)
    many = tabletop.make_vec("StackThree", 3, autoreset_mode="disabled", max_steps=2)
    with pytest.raises(tabletop.Error, match="environment 0: no episode has begun"):
        many.step(np.zeros((3, 16)))
    before, _ = many.reset(seed=0)
    actions = np.zeros((3, 16))
    actions[2, 4] = np.nan
    with pytest.raises(tabletop.Error, match="environment 2: number 4 of the action"):
        many.step(actions)
    with pytest.raises(tabletop.Error, match=r"expected actions of the shape \(3, 16\), found \(16, 3\)"):
        many.step(np.zeros((16, 3)))
    with pytest.raises(tabletop.Error, match="environment 1 is named twice"):
        many.send(np.zeros((2, 16)), [1, 1])
    for _ in range(2):
        many.step(np.zeros((3, 16)))
    with pytest.raises(tabletop.Error, match="environment 0: its episode is over; reset it first"):
        many.step(np.zeros((3, 16)))


def test_what_is_received_has_the_infos_of_its_rows():
    many = tabletop.make_vec("StackThree", 4, autoreset_mode="same_step", max_steps=2)
    many.reset(seed=0)
    actions = np.zeros((4, 16), np.float32)
    many.step(actions)
    many.send(actions[:2], [3, 1])
    seen, reward, done, cut, info = many.recv(2)
    assert cut.all() and len(seen) == 2 and sorted(info["env_id"]) == [1, 3]
    assert all(len(info[name]) == 2 for name in ("is_success", "failures", "final_obs"))
    assert info["_final_obs"].all() and all(info["final_info"]["failures"]) and not info["is_success"].any()


def test_the_reward_of_goals_is_what_hindsight_computes():
    one = tabletop.make("StackThree", goals=True)
    seen, _ = one.reset(seed=0)
    for _ in range(5):
        seen, reward, *_ = one.step(np.full(16, 0.2))
        assert reward == one.compute_reward(seen["achieved_goal"], seen["desired_goal"], {})
    with pytest.raises(tabletop.Error, match="goals: expected reward distance"):
        tabletop.make("StackThree", goals=True, reward="sparse")


@pytest.mark.parametrize("ticks, fps", [(1, 60), (3, 20), (12, 5), (7, 60 / 7)])
def test_pictures_are_as_many_a_second_as_steps(ticks, fps):
    for env in tabletop.make("StackThree", ticks_per_step=ticks), tabletop.make_vec("StackThree", 2, ticks_per_step=ticks):
        assert env.metadata["render_fps"] == fps and type(env.metadata["render_fps"]) is type(fps)


def test_environments_are_sent_and_received_as_they_are_ready():
    many = tabletop.make_vec("StackThree", 4, threads=2)
    many.reset(seed=0)
    actions = np.zeros((4, 16), np.float32)
    many.send(actions)
    count = 0
    for _ in range(10):
        seen, reward, done, cut, info = many.recv(2)
        assert seen.shape[0] == 2 == len(info["env_id"])
        count += 2
        many.send(actions[:2], info["env_id"])
    many.recv()
    with pytest.raises(tabletop.Error, match="send actions first"):
        many.recv(1)
    with pytest.raises(tabletop.Error, match="no environment 7"):
        many.send(actions[:1], [7])


def test_a_vector_of_a_parent_is_refused_in_its_child():
    many = tabletop.make_vec("StackThree", 2, threads=2)
    many.reset(seed=0)
    child = os.fork()
    if not child:
        try:
            many.step(np.zeros((2, 16)))
        except tabletop.Error as error:
            os._exit(0 if "forked" in str(error) else 1)
        os._exit(1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    many.step(np.zeros((2, 16)))


def test_ctrl_c_ends_a_vector_soon():
    program = """
import signal, threading, time, numpy, tabletop
many = tabletop.make_vec("StackThree", 64, threads=2, observation="rgb", size=(400, 300), ticks_per_step=60)
many.reset(seed=0)
began = time.time()
signal.setitimer(signal.ITIMER_REAL, 0.1)
signal.signal(signal.SIGALRM, signal.default_int_handler)
try:
    while True:
        many.step(numpy.random.uniform(-1, 1, (64, 16)))
except KeyboardInterrupt:
    print(time.time() - began)
"""
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120, check=True)
    assert float(done.stdout) < 1.5, done.stdout


def test_resets_do_not_grow_the_memory():
    env = tabletop.make("StackTwoBlocks", scatter=False)

    def resets(count):
        for seed in range(count):
            env.reset(seed=seed)
        with open("/proc/self/statm") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    before = resets(500)
    assert resets(2000) - before < 2 << 20


def test_importing_needs_neither_display_nor_gymnasium():
    program = """
import sys
sys.modules["gymnasium"] = None
import tabletop
tabletop.World("shipped:tablesetup/default.xml").picture()
"""
    bare = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    subprocess.run([sys.executable, "-c", program], env=bare, check=True)


def test_the_command_line():
    def run(*arguments):
        return subprocess.run([sys.executable, "-m", "tabletop", *arguments], capture_output=True, text=True)

    assert "Simulate a task file" in run("--help").stdout
    failed = run("run", "missing.ron")
    assert failed.returncode == 2 and "missing.ron" in failed.stderr


def test_stable_baselines_finds_no_fault():
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    for name in tabletop.registered():
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            checker.check_env(tabletop.make(name), warn=False)
    checker.check_env(tabletop.make("StackThree", observation="rgb"), warn=False)


def test_episodes_are_recorded(tmp_path):
    env = tabletop.make("StackThree", action="pick_place", record=tmp_path / "episodes")
    for _ in range(2):
        env.reset(seed=1)
        env.step(np.zeros(env.action_space.shape, np.float32))
    env.close()
    episodes = sorted((tmp_path / "episodes").iterdir())
    assert [episode.name for episode in episodes] == ["000000", "000001"]
    assert all(list(tabletop.Recording(episode).frames()) for episode in episodes)
