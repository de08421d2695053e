"""Trains a network for an epoch on robomimic's own SequenceDataset."""

import sys
import types
from importlib.metadata import version

sys.modules.setdefault("egl_probe", types.ModuleType("egl_probe"))  # it only looks for graphics cards

import robomimic.utils.obs_utils as obs_utils
import torch
from robomimic.utils.dataset import SequenceDataset

obs_utils.initialize_obs_utils_with_obs_specs({"obs": {"low_dim": ["state"], "rgb": ["head_image"]}})
dataset = SequenceDataset(
    hdf5_path=sys.argv[1], obs_keys=["state", "head_image"], dataset_keys=["actions", "rewards", "dones"], seq_length=4,
    frame_stack=1, hdf5_cache_mode=None, filter_by_attribute="train", load_next_obs=True,
)
sizes = dataset[0]["obs"]["state"].shape[-1], dataset[0]["actions"].shape[-1]
network = torch.nn.Sequential(torch.nn.Linear(sizes[0], 64), torch.nn.ReLU(), torch.nn.Linear(64, sizes[1]))
optimizer = torch.optim.Adam(network.parameters(), 1e-3)
losses = []
assert len(SequenceDataset(
    hdf5_path=sys.argv[1], obs_keys=["state"], dataset_keys=["actions"], hdf5_cache_mode=None, filter_by_attribute="valid",
)) > 0
for batch in torch.utils.data.DataLoader(dataset, batch_size=16, shuffle=True):
    assert float(batch["actions"].abs().max()) <= 1.0
    assert batch["next_obs"]["head_image"].shape == batch["obs"]["head_image"].shape
    loss = ((network(batch["obs"]["state"].float()) - batch["actions"].float()) ** 2).mean()
    optimizer.zero_grad()
    loss.backward()
    optimizer.step()
    losses.append(float(loss.detach()))
print(f"robomimic {version('robomimic')}: {dataset.n_demos} demonstrations, {len(dataset)} sequences, mean loss {sum(losses) / len(losses):.3f}")
dataset.close_and_delete_hdf5_handle()
