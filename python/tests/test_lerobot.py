"""LeRobot's plugin. `python/tools/check_lerobot.sh` runs LeRobot's own programs with it."""

import subprocess
import sys

import numpy as np
import pytest
from conftest import ROOT

import tabletop

pytest.importorskip("lerobot", reason="LeRobot is not installed: its plugin was not tried")
plugin = pytest.importorskip("lerobot_robot_tabletop", reason="lerobot_robot_tabletop is not installed: it was not tried")
from lerobot.envs.configs import EnvConfig  # noqa: E402
from lerobot.envs.factory import make_env  # noqa: E402
from lerobot.envs.utils import env_to_policy_features, preprocess_observation  # noqa: E402
from lerobot.robots.config import RobotConfig  # noqa: E402
from lerobot.robots.utils import make_robot_from_config  # noqa: E402
from lerobot.teleoperators.config import TeleoperatorConfig  # noqa: E402
from lerobot.teleoperators.utils import make_teleoperator_from_config  # noqa: E402
from lerobot.utils.import_utils import register_third_party_plugins  # noqa: E402

ARM = str(ROOT / "assets/panda/robot.ron")
LEROBOTS = str(ROOT / "assets/so101/robot.ron")
LIFT = str(ROOT / "examples/learn/lift_block.ron")


@pytest.fixture(scope="module")
def recording(tmp_path_factory):
    """A recording in which the arm lifts the block."""
    folder = tmp_path_factory.mktemp("recordings")
    for command in (
        ["run", LIFT, "--record", "demo", "--quiet"],
        ["multiply", "demo", "--count", "1", "--out", "many", "--robot", ARM],
    ):
        subprocess.run([sys.executable, "-m", "tabletop", *command], cwd=folder, check=True, capture_output=True)
    return folder / "many/0000"


def test_lerobot_finds_it():
    register_third_party_plugins()
    for config, name in (EnvConfig, "tabletop"), (RobotConfig, "tabletop"), (TeleoperatorConfig, "tabletop_recording"):
        assert name in config.get_known_choices()


@pytest.mark.parametrize("kind", ["pixels_agent_pos", "environment_state_agent_pos"])
def test_observations_have_the_features_that_policies_are_told(kind):
    config = plugin.TabletopEnvConfig(
        task=LIFT, robot=ARM, obs_type=kind, cameras="head,side=3,-4,5", observation_width=40, observation_height=30
    )
    (env,) = make_env(config, n_envs=2)["tabletop"].values()
    seen, _ = env.reset(seed=[1, 2])
    features = env_to_policy_features(config)
    shown = preprocess_observation(seen)
    assert {name: tuple(part.shape[1:]) for name, part in shown.items()} == {
        name: tuple(feature.shape) for name, feature in features.items() if name != "action"
    }
    assert env.single_action_space.shape == tuple(features["action"].shape)
    env.close()


def test_policies_are_told_the_sentence_of_the_episode():
    config = plugin.TabletopEnvConfig(task="Instruction", observation_width=40, observation_height=30)
    (env,) = make_env(config, n_envs=1)["tabletop"].values()
    env.reset(seed=[3])
    assert hasattr(env.envs[0], "task_description")
    assert env.call("task_description")[0].endswith(".")
    assert env.call("_max_episode_steps")[0] == config.episode_length
    env.close()


def test_a_robot_that_a_recording_leads_does_what_it_shows(recording):
    robot = make_robot_from_config(plugin.TabletopRobotConfig(robot=ARM, recording=str(recording), fps=10))
    leader = make_teleoperator_from_config(plugin.TabletopRecordingConfig(recording=str(recording), fps=10))
    assert robot.action_features == leader.action_features
    with robot, leader:
        assert set(robot.get_observation()) == set(robot.observation_features)
        ticks = int(tabletop.Recording(recording).joints()["tick"][-1])
        for _ in range(ticks // 6 + 1):
            robot.send_action(leader.get_action())
        assert robot.world.objects.location[0][2] > 0.7
        assert robot.world.robot.limbs["panda"].holds == ["Block"]


def test_leader_arms_of_lerobot_have_its_joints_in_degrees():
    robot = make_robot_from_config(plugin.TabletopRobotConfig(robot=LEROBOTS, fps=10, degrees=True))
    joints = ["shoulder_pan", "shoulder_lift", "elbow_flex", "wrist_flex", "wrist_roll", "gripper"]
    assert sorted(robot.action_features) == sorted(f"{joint}.pos" for joint in joints)
    with robot:
        action = {f"{joint}.pos": 0.0 for joint in joints} | {"shoulder_pan.pos": 10.0, "gripper.pos": 100.0}
        robot.send_action(action)
        assert robot.world.robot.joints["shoulder_pan"] == pytest.approx(np.radians(10), abs=1e-4)
        assert robot.get_observation()["gripper.pos"] == pytest.approx(100, abs=0.1)
    with pytest.raises(ConnectionError):
        robot.get_observation()
