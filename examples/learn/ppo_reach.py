"""Learns to reach a point with an arm, by proximal policy optimisation in one file, as CleanRL has it. Needs torch.

    python examples/learn/ppo_reach.py --steps 300000 --curve ppo_reach.csv

prints the share of the episodes that reached their target, and writes it as a table of steps and shares.
"""

import argparse
import csv
import time

import numpy as np
import torch
from torch import nn
from torch.distributions.normal import Normal

import tabletop

ENVS, LENGTH, EPOCHS, BATCHES = 32, 64, 6, 8
GAMMA, LAMBDA, CLIP, ENTROPY, RATE = 0.98, 0.95, 0.2, 0.002, 1e-3


class Agent(nn.Module):
    """A policy with a normal distribution of actions, and the value of states."""

    def __init__(self, numbers: int, actions: int):
        super().__init__()

        def network(out: int, gain: float) -> nn.Sequential:
            layers = [nn.Linear(numbers, 64), nn.Tanh(), nn.Linear(64, 64), nn.Tanh(), nn.Linear(64, out)]
            for layer, scale in (layers[0], 2**0.5), (layers[2], 2**0.5), (layers[4], gain):
                nn.init.orthogonal_(layer.weight, scale)
                nn.init.zeros_(layer.bias)
            return nn.Sequential(*layers)

        self.mean, self.value = network(actions, 0.01), network(1, 1.0)
        self.spread = nn.Parameter(torch.full((actions,), -0.5))

    def act(self, seen: torch.Tensor, action: torch.Tensor | None = None):
        policy = Normal(self.mean(seen), self.spread.exp())
        action = policy.sample() if action is None else action
        return action, policy.log_prob(action).sum(-1), policy.entropy().sum(-1), self.value(seen).squeeze(-1)


def main() -> None:
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("--steps", type=int, default=300_000)
    arguments.add_argument("--seed", type=int, default=0)
    arguments.add_argument("--curve")
    arguments = arguments.parse_args()
    torch.manual_seed(arguments.seed)
    torch.set_num_threads(1)
    many = tabletop.make_vec("Reach", ENVS, action="end_effector_delta", max_steps=100, autoreset_mode="same_step")
    names = many.state_names
    # The arm's place and the target are all that matters.
    used = [names.index(f"right.end_effector.{axis}") for axis in "xyz"]
    used += [names.index(f"goal0.desired.{axis}") for axis in "xyz"]

    def see(state: np.ndarray) -> torch.Tensor:
        return torch.as_tensor(state[:, used] / 5)

    agent = Agent(len(used), many.single_action_space.shape[0])
    optimizer = torch.optim.Adam(agent.parameters(), RATE, eps=1e-5)
    seen = see(many.reset(seed=arguments.seed)[0])
    curve, steps, start = [], 0, time.time()
    while steps < arguments.steps:
        rows, over, reached = [], 0, 0
        for _ in range(LENGTH):
            with torch.no_grad():
                action, log, _, value = agent.act(seen)
            state, reward, done, cut, info = many.step(action.numpy())
            rows.append((seen, action, log, value, torch.as_tensor(reward, dtype=torch.float32), torch.as_tensor(done | cut).float()))
            seen = see(state)
            over, reached = over + int((done | cut).sum()), reached + int(done.sum())
        steps += LENGTH * ENVS
        saw, actions, logs, values, rewards, ends = map(torch.stack, zip(*rows))
        with torch.no_grad():
            later = agent.value(seen).squeeze(-1)
            gains, gain = torch.zeros_like(rewards), 0.0
            for row in reversed(range(LENGTH)):
                going = 1 - ends[row]
                delta = rewards[row] + GAMMA * later * going - values[row]
                gain = delta + GAMMA * LAMBDA * going * gain
                gains[row], later = gain, values[row]
        flat = [it.flatten(0, 1) for it in (saw, actions, logs, gains, gains + values)]
        for _ in range(EPOCHS):
            for batch in torch.randperm(LENGTH * ENVS).chunk(BATCHES):
                saw_, actions_, logs_, gains_, returns_ = (it[batch] for it in flat)
                _, log, entropy, value = agent.act(saw_, actions_)
                ratio = (log - logs_).exp()
                gains_ = (gains_ - gains_.mean()) / (gains_.std() + 1e-8)
                policy = -torch.min(gains_ * ratio, gains_ * ratio.clamp(1 - CLIP, 1 + CLIP)).mean()
                loss = policy + 0.5 * (value - returns_).square().mean() - ENTROPY * entropy.mean()
                optimizer.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(agent.parameters(), 0.5)
                optimizer.step()
        if over:
            curve.append((steps, reached / over))
            print(f"{steps:8} steps, {reached / over:4.0%} of {over} episodes reached it, {steps / (time.time() - start):.0f} steps/s", flush=True)
    if arguments.curve:
        with open(arguments.curve, "w", newline="") as file:
            csv.writer(file).writerows([("steps", "reached"), *curve])


if __name__ == "__main__":
    main()
