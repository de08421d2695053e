"""Reads an RLDS dataset with TensorFlow Datasets."""

import sys

import tensorflow_datasets as tfds

dataset = tfds.builder_from_directory(sys.argv[1]).as_dataset(split="train")
episodes = frames = 0
for episode in dataset:
    steps = list(episode["steps"])
    assert bool(steps[0]["is_first"]) and bool(steps[-1]["is_last"]) and not bool(steps[0]["is_last"])
    assert steps[0]["observation"]["head_image"].shape[-1] == 3
    assert steps[0]["language_instruction"].numpy().endswith(b".")
    episodes, frames = episodes + 1, frames + len(steps)
assert episodes
print(f"TensorFlow Datasets {tfds.__version__}: {episodes} episodes, {frames} frames")
