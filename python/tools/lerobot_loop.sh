#!/usr/bin/env bash
# From one demonstration to a policy of LeRobot, and how often that does the task: lerobot_loop.sh lift_block|stack_blocks poses|pictures OUT
# The policy is told where the objects are (poses), or sees the table through a camera that stands opposite the robot (pictures).
# What is there in OUT stays, so the same command goes on where it ended. PYTHON names a Python in which `tabletop`, LeRobot and `lerobot_robot_tabletop` are
# installed [python]. EPISODES [200], STEPS [20000], TRIALS [100] and BATCH [64] are numbers of demonstrations, of steps and trials, and of frames in a step.
set -euo pipefail
(($# == 3)) || { sed -n 2,5p "$0" >&2; exit 2; }
task=$1 sees=$2
mkdir -p "$3"
out=$(realpath "$3")
cd "$(dirname "$0")/../.."
python=${PYTHON:-python}
programs=$(dirname "$("$python" -c 'import sys; print(sys.executable)')")
export HF_HUB_OFFLINE=1
robot=assets/panda/robot.ron
camera=front=0,5,4.5,0,0,0.2
fps=10 size=96 steps=${STEPS:-20000}

case $task in
  lift_block) words="Pick up the red block." length=60 ;;
  stack_blocks) words="Put the red block on the blue block." length=120 ;;
  *) echo "there is no task $task, only lift_block and stack_blocks" >&2; exit 2 ;;
esac
case $sees in
  poses) obs_type=environment_state_agent_pos episode="--state both --cameras none" ;;
  pictures) obs_type=pixels_agent_pos episode="--state robot --cameras $camera --size ${size}x$size" ;;
  *) echo "a policy cannot see $sees, only poses and pictures" >&2; exit 2 ;;
esac

[[ -d $out/demo ]] || "$python" -m tabletop run "examples/learn/$task.ron" --record "$out/demo" --quiet
"$python" -m tabletop multiply "$out/demo" --count "${EPISODES:-200}" --out "$out/many" --robot "$robot"
[[ -d $out/$sees ]] || "$python" -m tabletop export "$out/many" --to lerobot "$out/$sees" --action joints --fps $fps $episode
[[ -d $out/train-$sees ]] || "$programs/lerobot-train" --dataset.repo_id="local/$task" --dataset.root="$out/$sees" \
  --policy.type=act --policy.push_to_hub=false --policy.device=cpu --policy.pretrained_backbone_weights=null --policy.use_vae=false --policy.dropout=0 \
  --policy.dim_model=64 --policy.dim_feedforward=256 --policy.n_heads=4 --policy.n_encoder_layers=2 --policy.chunk_size=16 --policy.n_action_steps=8 \
  --use_policy_training_preset=false --optimizer.type=adamw --optimizer.lr=1e-3 --optimizer.weight_decay=1e-4 \
  --scheduler.type=cosine_decay_with_warmup --scheduler.num_warmup_steps=200 --scheduler.num_decay_steps="$steps" --scheduler.peak_lr=1e-3 \
  --scheduler.decay_lr=1e-5 --batch_size="${BATCH:-64}" --steps="$steps" --log_freq=100 --save_freq="$steps" \
  --num_workers=1 --wandb.enable=false --output_dir="$out/train-$sees"
rm -rf "$out/eval-$sees"
"$programs/lerobot-eval" --policy.path="$out/train-$sees/checkpoints/last/pretrained_model" --policy.device=cpu \
  --env.type=tabletop --env.task="examples/learn/$task.ron" --env.instruction="$words" --env.robot="$robot" --env.obs_type=$obs_type --env.fps=$fps \
  --env.cameras=$camera --env.observation_width=$size --env.observation_height=$size --env.episode_length=$length \
  --eval.n_episodes="${TRIALS:-100}" --eval.batch_size=10 --seed=10000 --output_dir="$out/eval-$sees"
"$python" python/tools/wilson.py "$out/eval-$sees/eval_info.json"
