"""Says how often a policy of LeRobot did a task, with Wilson's interval of 95 %: wilson.py OUTPUT_DIR/eval_info.json"""

import json
import math
import sys

Z = 1.959964


def interval(successes: int, trials: int) -> tuple[float, float]:
    share = successes / trials
    spread = Z * math.sqrt(share * (1 - share) / trials + Z * Z / (4 * trials * trials))
    scale = 1 + Z * Z / trials
    middle = share + Z * Z / (2 * trials)
    return (middle - spread) / scale, (middle + spread) / scale


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        episodes = json.load(file)["per_task"][0]["metrics"]["successes"]
    low, high = interval(sum(episodes), len(episodes))
    print(f"{sum(episodes)} of {len(episodes)}: {sum(episodes) / len(episodes):.0%} ({low:.0%} to {high:.0%})")
