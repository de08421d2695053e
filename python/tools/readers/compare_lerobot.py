"""Compares the pictures of a LeRobot dataset with videos, frame by frame, with those of the same one whose pictures are PNG files."""

import sys
from importlib.metadata import version

import numpy as np
from lerobot.datasets.lerobot_dataset import LeRobotDataset

# Largest mean difference of a frame's colours, of 1: what AV1 loses. The same frame a tenth of a second later differs by more where something moves.
LOSS = 0.012

videos, pictures = (LeRobotDataset("local/check", root=root, video_backend="pyav") for root in sys.argv[1:3])
assert videos.meta.video_keys and not pictures.meta.video_keys
assert len(videos) == len(pictures), (len(videos), len(pictures))
worst, nearest = 0.0, 0
for index in range(len(videos)):
    shown, expected = videos[index], pictures[index]
    for name in ("episode_index", "frame_index", "timestamp", "task"):
        assert shown[name] == expected[name], (index, name, shown[name], expected[name])
    for name in videos.meta.video_keys:
        loss = float((shown[name] - expected[name]).abs().mean())
        assert loss < LOSS, (index, name, loss)
        worst = max(worst, loss)
for name, stats in videos.meta.stats.items():
    # A trimmed video keeps the statistics of the whole.
    if name in videos.meta.video_keys and stats["count"] != pictures.meta.stats[name]["count"]:
        continue
    for number, values in stats.items():
        assert np.allclose(values, pictures.meta.stats[name][number], atol=1e-6), (name, number)
print(f"LeRobot {version('lerobot')}: {len(videos)} frames are those of the pictures, but for {worst:.4f} of the colours on average at worst")
