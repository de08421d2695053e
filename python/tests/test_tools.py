"""The tools beside LeRobot's programs."""

import sys

import pytest
from conftest import ROOT

sys.path.insert(0, str(ROOT / "python/tools"))
from wilson import interval  # noqa: E402

@pytest.mark.parametrize(
    ("successes", "trials", "low", "high"), [(8, 10, 0.490, 0.943), (0, 20, 0.0, 0.161), (100, 100, 0.963, 1.0)]
)
def test_intervals_are_wilsons(successes, trials, low, high):
    assert interval(successes, trials) == pytest.approx((low, high), abs=5e-4)
