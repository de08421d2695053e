"""The tools beside LeRobot's programs."""

import json
import subprocess
import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "python/tools"))
from wilson import interval  # noqa: E402

ARM = str(ROOT / "assets/panda/robot.ron")
LIFT = str(ROOT / "examples/learn/lift_block.ron")


def run(folder, *command):
    subprocess.run([sys.executable, *command], cwd=folder, check=True, capture_output=True)


@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"), [(8, 10, 0.490, 0.943), (0, 20, 0.0, 0.161), (100, 100, 0.963, 1.0)]
)
def test_intervals_are_wilsons(successes, trials, low, high):
    assert interval(successes, trials) == pytest.approx((low, high), abs=5e-4)


def test_a_state_is_parted_into_joints_and_poses(tmp_path):
    pq = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed: split_state.py was not tried")
    run(tmp_path, "-m", "tabletop", "run", LIFT, "--record", "demo", "--quiet")
    run(tmp_path, "-m", "tabletop", "multiply", "demo", "--count", "1", "--out", "many", "--robot", ARM)
    run(tmp_path, "-m", "tabletop", "export", "many", "--to", "lerobot", "both", "--state", "both", "--action", "joints")
    run(tmp_path, str(ROOT / "python/tools/split_state.py"), "both", "poses")
    features = json.loads((tmp_path / "poses/meta/info.json").read_text())["features"]
    stats = json.loads((tmp_path / "poses/meta/stats.json").read_text())
    both, poses = (pq.read_table(tmp_path / name / "data/chunk-000/file-000.parquet") for name in ("both", "poses"))
    assert features["observation.state"]["names"] == features["action"]["names"]
    assert features["observation.environment_state"]["names"] == [f"Block.{part}" for part in ("x", "y", "z", "qx", "qy", "qz", "qw")]
    assert not any("images" in name for name in features)
    for whole, joints, objects in zip(*(table[name].to_pylist() for table, name in (
        (both, "observation.state"), (poses, "observation.state"), (poses, "observation.environment_state")
    ))):
        assert whole[:15] == joints + objects
    assert len(stats["observation.environment_state"]["mean"]) == 7
    assert poses["action"] == both["action"]
