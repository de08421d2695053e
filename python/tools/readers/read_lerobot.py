"""Iterates a LeRobot dataset with LeRobot's own loader, and compares its pictures with the PNG files of the recordings."""

import sys
from importlib.metadata import version

import numpy as np
import torch
from lerobot.datasets.lerobot_dataset import LeRobotDataset
from PIL import Image

root, recordings = sys.argv[1], sys.argv[2:]
dataset = LeRobotDataset("local/check", root=root, video_backend="pyav")
collate = None
if any(name.startswith("language") for name in dataset.meta.features):
    from lerobot.utils.collate import lerobot_collate_fn as collate
assert dataset.num_episodes == len(recordings), dataset.num_episodes
assert len(dataset) > 0
tasks, compared = set(), 0
for index in range(len(dataset)):
    item = dataset[index]
    tasks.add(item["task"])
    pictures = [name for name in item if name.startswith("observation.images.")]
    assert pictures, "there are no pictures"
    if dataset.meta.video_keys or int(item["frame_index"]) != 0:
        continue
    shown = (item["observation.images.head"].permute(1, 2, 0).numpy() * 255).round().astype(np.uint8)
    recorded = Image.open(f"{recordings[int(item['episode_index'])]}/0/0.png").convert("RGB")
    assert (shown == np.asarray(recorded)).all(), "a picture differs"
    compared += 1
batches = torch.utils.data.DataLoader(dataset, batch_size=8, collate_fn=collate)
assert sum(len(batch["index"]) for batch in batches) == len(dataset)
assert all(task.endswith(".") for task in tasks), tasks
print(f"LeRobot {version('lerobot')}: {dataset.num_episodes} episodes, {len(dataset)} frames, {compared} pictures compared, tasks {sorted(tasks)}")
