"""`--env.type=tabletop`."""

from __future__ import annotations

from dataclasses import dataclass

from lerobot.configs.types import FeatureType, PolicyFeature
from lerobot.envs.configs import EnvConfig
from lerobot.utils.constants import ACTION, OBS_ENV_STATE, OBS_IMAGES, OBS_STATE

import tabletop
from tabletop.cameras import camera_list
from tabletop.joint_env import JointEnv

# Not every version of Gymnasium asks packages for their environments.
tabletop.gym.register()


@EnvConfig.register_subclass("tabletop")
@dataclass
class TabletopEnvConfig(EnvConfig):
    """The options of `JointEnv`; `cameras` is a list as in `tabletop export --cameras`."""

    task: str | None = "Instruction"
    fps: int = 10
    episode_length: int = 100
    instruction: str = ""
    robot: str | None = None
    obs_type: str = "pixels_agent_pos"
    cameras: str = "head"
    observation_height: int = 96
    observation_width: int = 96
    render_mode: str = "rgb_array"

    def __post_init__(self) -> None:
        env = JointEnv(**self.gym_kwargs)
        action, seen = env.action_space, env.observation_space
        self.features = {
            ACTION: PolicyFeature(FeatureType.ACTION, action.shape),
            "agent_pos": PolicyFeature(FeatureType.STATE, seen["agent_pos"].shape),
        }
        self.features_map = {ACTION: ACTION, "agent_pos": OBS_STATE}
        if "environment_state" in seen.spaces:
            self.features["environment_state"] = PolicyFeature(FeatureType.ENV, seen["environment_state"].shape)
            self.features_map["environment_state"] = OBS_ENV_STATE
        if "pixels" in seen.spaces:
            for camera, picture in seen["pixels"].items():
                self.features[f"pixels/{camera}"] = PolicyFeature(FeatureType.VISUAL, picture.shape)
                self.features_map[f"pixels/{camera}"] = f"{OBS_IMAGES}.{camera}"

    @property
    def package_name(self) -> str:
        return "tabletop"

    @property
    def gym_id(self) -> str:
        return "tabletop/Joints-v0"

    @property
    def gym_kwargs(self) -> dict:
        return {
            "task": self.task,
            "instruction": self.instruction,
            "robot": self.robot,
            "obs_type": self.obs_type,
            "cameras": camera_list(self.cameras),
            "size": (self.observation_width, self.observation_height),
            "fps": self.fps,
            "episode_length": self.episode_length,
            "render_mode": self.render_mode,
        }
