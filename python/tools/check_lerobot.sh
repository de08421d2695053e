#!/usr/bin/env bash
# Runs LeRobot's own programs with tabletop's plugin: check_lerobot.sh. PYTHON names a Python in which `tabletop`, LeRobot and `lerobot_robot_tabletop` are installed [python].
set -euo pipefail
cd "$(dirname "$0")/../.."
python=${PYTHON:-python}
programs=$(dirname "$("$python" -c 'import sys; print(sys.executable)')")
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
export HF_HUB_OFFLINE=1 HF_LEROBOT_HOME=$work/home
arm=assets/panda/robot.ron
policy=(--policy.type=act --policy.push_to_hub=false --policy.device=cpu --policy.pretrained_backbone_weights=null --policy.dim_model=64
  --policy.dim_feedforward=64 --policy.n_encoder_layers=1 --policy.n_vae_encoder_layers=1 --policy.chunk_size=10 --policy.n_action_steps=10)
env=(--env.type=tabletop --env.robot="$arm" --env.task=examples/learn/lift_block.ron --env.observation_width=64 --env.observation_height=48 --env.episode_length=20)

"$python" -m pytest --quiet python/tests/test_lerobot.py
"$python" -m tabletop run examples/learn/lift_block.ron --record "$work/demo" --quiet
"$python" -m tabletop multiply "$work/demo" --count 3 --out "$work/many" --robot "$arm" >/dev/null
"$python" -m tabletop export "$work/many" --to lerobot "$work/set" --state robot --action joints --fps 10 --size 64x48 >/dev/null

# LeRobot 0.6 calls it otherwise.
frequency=$("$python" -c 'from lerobot.configs.train import TrainPipelineConfig as T; print("env_eval_freq" if hasattr(T, "env_eval_freq") else "eval_freq")')
echo "== lerobot-train, with evaluation"
"$programs/lerobot-train" --dataset.repo_id=local/set --dataset.root="$work/set" "${policy[@]}" "${env[@]}" --batch_size=2 --steps=4 "--$frequency=4" \
  --eval.n_episodes=2 --eval.batch_size=2 --num_workers=0 --wandb.enable=false --output_dir="$work/train"
echo "== lerobot-eval"
"$programs/lerobot-eval" --policy.path="$work/train/checkpoints/last/pretrained_model" --policy.device=cpu "${env[@]}" \
  --eval.n_episodes=3 --eval.batch_size=2 --output_dir="$work/eval"
"$python" python/tools/wilson.py "$work/eval/eval_info.json"
echo "== lerobot-teleoperate"
robot=(--robot.type=tabletop --robot.id=arm --robot.robot="$arm" --robot.recording="$work/many/0000" --robot.fps=10)
leader=(--teleop.type=tabletop_recording --teleop.id=leader --teleop.recording="$work/many/0000" --teleop.fps=10)
"$programs/lerobot-teleoperate" "${robot[@]}" "${leader[@]}" --fps=10 --teleop_time_s=2
echo "== lerobot-record"
"$programs/lerobot-record" "${robot[@]}" "${leader[@]}" --dataset.repo_id=local/recorded --dataset.root="$work/recorded" --dataset.single_task="Pick up the red block." \
  --dataset.fps=10 --dataset.num_episodes=1 --dataset.episode_time_s=8 --dataset.video=false --dataset.push_to_hub=false --play_sounds=false
echo "== lerobot-replay, of what lerobot-record has recorded and of what was exported"
"$programs/lerobot-replay" "${robot[@]}" --robot.record="$work/replayed" --dataset.repo_id=local/recorded --dataset.root="$work/recorded" --dataset.episode=0 --play_sounds=false
"$python" -m tabletop explain "$work/replayed"
"$programs/lerobot-replay" "${robot[@]}" --dataset.repo_id=local/set --dataset.root="$work/set" --dataset.episode=0 --play_sounds=false
