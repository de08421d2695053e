"""Edits a LeRobot dataset as `lerobot-edit-dataset` does: deletes episodes, splits and merges."""

import sys
from pathlib import Path

from lerobot.datasets.dataset_tools import delete_episodes, merge_datasets, split_dataset
from lerobot.datasets.lerobot_dataset import LeRobotDataset

source, out = sys.argv[1], Path(sys.argv[2])
dataset = LeRobotDataset("local/check", root=source, video_backend="pyav")
delete_episodes(dataset, [0], output_dir=out / "delete")
parts = split_dataset(dataset, {"train": [0, 1, 2], "valid": [3]}, output_dir=out)
merge_datasets([parts["valid"], parts["train"]], "local/merged", output_dir=out / "merge")
