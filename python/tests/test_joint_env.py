"""Environments for policies that have learned from exported datasets."""

import json
import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

import tabletop

gymnasium = pytest.importorskip("gymnasium")
from tabletop.cameras import camera_list, camera_name  # noqa: E402
from tabletop.joint_env import JointEnv  # noqa: E402

ARM = str(ROOT / "assets/panda/robot.ron")
LIFT = str(ROOT / "examples/learn/lift_block.ron")


def made(**options):
    return JointEnv(LIFT, robot=ARM, **options)


def test_observations_are_in_their_space_and_have_what_was_asked_for():
    seen, info = made(cameras=["head", "side=3,-4,5"], size=(40, 30)).reset(seed=1)
    assert sorted(seen) == ["agent_pos", "pixels"] and not info["is_success"]
    assert {name: picture.shape for name, picture in seen["pixels"].items()} == {"head": (30, 40, 3), "side": (30, 40, 3)}
    env = made(obs_type="environment_state_agent_pos")
    seen, _ = env.reset(seed=1)
    assert seen in env.observation_space and seen["environment_state"].shape == (7,)
    assert seen["environment_state"][2] == pytest.approx(0.2, abs=0.01)


def test_an_action_says_where_the_joints_are_in_the_end():
    env = made()
    seen, _ = env.reset(seed=2)
    near = seen["agent_pos"] + np.float32([0.05, 0, 0, 0, 0, 0, -0.05, 0])
    after, *_ = env.step(near)
    assert after["agent_pos"] == pytest.approx(near, abs=1e-5)
    far = near + np.float32([2.0, 0, 0, 0, 0, 0, 0, 0])
    after, *_ = env.step(far)
    assert 0.05 < after["agent_pos"][0] - near[0] < 1.0, "as far as the joint's speed takes it in a tenth of a second"


def test_an_action_beyond_a_limit_goes_to_the_limit():
    env = made()
    env.reset(seed=2)
    for _ in range(40):
        seen, *_ = env.step(np.full(8, 10.0))
    assert seen["agent_pos"][0] == pytest.approx(env.action_space.high[0], abs=1e-5)


def test_an_episode_is_cut_off_after_its_length():
    env = made(episode_length=2)
    seen, _ = env.reset(seed=3)
    assert not env.step(seen["agent_pos"])[3]
    assert env.step(seen["agent_pos"])[3]


def test_gymnasium_and_lerobot_find_it_bare():
    tabletop.gym.register()
    env = gymnasium.make("tabletop/Joints-v0", task="Instruction")
    assert type(env) is JointEnv
    env.reset(seed=4)
    assert env.task_description.endswith(".")
    told = env.task_description
    env.reset(seed=5)
    assert env.task_description != told


@pytest.mark.parametrize("options", [{"fps": 7}, {"obs_type": "pixels"}, {"cameras": ["nose"]}])
def test_what_makes_no_sense_is_refused(options):
    with pytest.raises(tabletop.Error):
        made(**options)


def test_cameras_are_listed_as_for_export():
    cameras = camera_list("head, left_hand,side=12,-4,7,0,0,1")
    assert cameras == ["head", "left_hand", "side=12,-4,7,0,0,1"]
    assert [camera_name(camera) for camera in cameras] == ["head", "left_hand", "side"]


def test_the_actions_of_an_exported_dataset_do_its_task(tmp_path):
    """The robot of the environment does what that of the dataset did, from where that began."""
    pq = pytest.importorskip("pyarrow.parquet")
    for command in (
        ["run", LIFT, "--record", "demo", "--quiet"],
        ["multiply", "demo", "--count", "2", "--out", "many", "--robot", ARM],
        ["export", "many", "--to", "lerobot", "set", "--fps", "10", "--size", "40x30"],
        ["export", "many", "--to", "lerobot", "poses", "--state", "both", "--cameras", "none", "--fps", "10"],
    ):
        subprocess.run([sys.executable, "-m", "tabletop", *command], cwd=tmp_path, check=True, capture_output=True)
    features = json.loads((tmp_path / "set/meta/info.json").read_text())["features"]
    env = made(size=(40, 30))
    assert features["action"]["names"] == features["observation.state"]["names"] == env.joint_names
    assert features["observation.images.head"]["shape"] == [30, 40, 3]
    rows, told = (
        [row for row in pq.read_table(tmp_path / name / "data/chunk-000/file-000.parquet").to_pylist() if row["episode_index"] == 0]
        for name in ("set", "poses")
    )
    assert [row["observation.state"] for row in told] == [row["observation.state"] for row in rows]
    assert any(row["action"][-1] == 0 for row in rows), "fingers that hold something are to close entirely"
    tabletop.World(recording=tmp_path / "many/0000", robot=ARM).save(tmp_path / "desk-block.xml")
    (tmp_path / "lift_block.ron").write_text((ROOT / "examples/learn/lift_block.ron").read_text())
    env = JointEnv(str(tmp_path / "lift_block.ron"), robot=ARM, scatter=False, size=(40, 30))
    seen, _ = env.reset(seed=0)
    for row in rows:
        *joints, fingers = row["observation.state"]
        assert seen["agent_pos"][:-1] == pytest.approx(joints, abs=0.03)
        # They begin to move with the frame within which they began in the demonstration: 2 units/s for up to 0.1 s.
        assert seen["agent_pos"][-1] == pytest.approx(fingers, abs=0.2)
        seen, _, success, _, _ = env.step(np.array(row["action"]))
        if success:
            break
    assert success
    env = JointEnv(str(tmp_path / "lift_block.ron"), robot=ARM, scatter=False, obs_type="environment_state_agent_pos")
    seen, _ = env.reset(seed=0)
    assert seen["environment_state"] == pytest.approx(told[0]["observation.environment_state"], abs=1e-3)
