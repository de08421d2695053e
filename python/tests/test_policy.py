"""A learned policy in the hands of a Python program."""

import subprocess
import sys

import numpy as np
import pytest

import tabletop


def command(*arguments):
    subprocess.run([sys.executable, "-m", "tabletop", *map(str, arguments)], check=True, capture_output=True)


def test_a_policy_acts_in_an_environment(tmp_path):
    demo, file = tmp_path / "demo", tmp_path / "policy.safetensors"
    command("run", "shipped:scenarios/red_on_blue.ron", "--record", demo, "--quiet")
    command("learn", demo, "--out", file, "--count", 4, "--samples", 4, "--trials", 0)
    policy = tabletop.Policy(file)
    env = tabletop.make("RedOnBlue", observation="rgb", size=(200, 150), action="pick_place")
    picture, _ = env.reset(seed=7)
    action = policy.decide(picture)
    # A policy that has hardly learned may think that there is nothing to do.
    if action is not None:
        assert action in env.action_space
        env.step(action)
    with pytest.raises(tabletop.Error, match="rows x columns x 3"):
        policy.decide(np.zeros((150, 200, 4), np.uint8))
    with pytest.raises(tabletop.Error, match="no_policy"):
        tabletop.Policy(tmp_path / "no_policy.safetensors")
