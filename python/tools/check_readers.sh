#!/usr/bin/env bash
# Exports recordings to every format, and lets the tools' own readers read them: check_readers.sh [light] [octave] [lerobot] [robomimic] [rlds].
# Ends with 3 if a reader cannot be installed. Each reader gets a Python environment of its own below ~/.cache/tabletop/readers, made with pip; lerobot takes half an hour the first time.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${TABLETOP:-${CARGO_TARGET_DIR:-target}/release/tabletop}
environments=${XDG_CACHE_HOME:-$HOME/.cache}/tabletop/readers
readers=python/tools/readers
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
(($#)) || set -- light octave lerobot robomimic rlds

# A Python in which these packages are installed.
python_with() {
  local environment=$environments/$1
  shift
  [[ -x $environment/bin/python ]] || python3 -m venv "$environment" >&2
  "$environment/bin/python" -m pip install --quiet --disable-pip-version-check "$@" >&2 || return
  echo "$environment/bin/python"
}

"$program" run scenarios/stack_three.ron --record "$work/demo" --quiet
"$program" multiply "$work/demo" --count 4 --out "$work/many" >/dev/null
recordings=("$work"/many/000?)
"$program" export "$work/many" --to lerobot "$work/lerobot" --no-language >/dev/null
"$program" export "$work/many" --to lerobot "$work/lerobot_video" --no-language --video --fps 10 --size 96x72 >/dev/null
"$program" export "$work/many" --to robomimic "$work/robomimic.hdf5" >/dev/null
"$program" export "$work/many" --to rlds "$work/rlds" >/dev/null
"$program" export "$work/many" --to mcap "$work/mcap" >/dev/null
"$program" export "$work/many" --to mat "$work/mat" >/dev/null

for reader in "$@"; do
  echo "== $reader"
  case $reader in
    light)
      python=$(python_with light h5py pyarrow mcap) || exit 3
      "$python" "$readers/read_light.py" "$work"
      ;;
    octave)
      octave --quiet --eval "e = load('$work/mat/episode-000000.mat'); assert(size(e.head_image, 3), 3);
        assert(size(e.state, 1), size(e.head_image, 4)); printf('Octave %s: %d frames, %s\n', version, size(e.state, 1), char(e.task));"
      ;;
    lerobot)
      python=$(python_with lerobot lerobot) || exit 3
      "$python" "$readers/read_lerobot.py" "$work/lerobot" "${recordings[@]}"
      "$python" "$readers/read_lerobot.py" "$work/lerobot_video" "${recordings[@]}"
      # What is done to videos and to PNG files gives the same frames.
      "$program" export "$work/many" --to lerobot "$work/lerobot_small" --no-language --fps 10 --size 96x72 >/dev/null
      for set in lerobot_video lerobot_small; do
        "$program" dataset drop "$work/$set" "$work/$set.drop" --episodes 1 >/dev/null
        "$program" dataset merge "$work/$set" "$work/$set.drop" --out "$work/$set.merge" >/dev/null
        "$program" dataset split "$work/$set" "$work/$set.split" --into train=3,valid=1 >/dev/null
        "$program" dataset trim "$work/$set" "$work/$set.trim" >/dev/null
      done
      for part in drop merge split/train split/valid trim; do
        "$python" "$readers/compare_lerobot.py" "$work/lerobot_video.$part" "$work/lerobot_small.$part"
      done
      ;;
    robomimic)
      python=$(python_with robomimic torch torchvision h5py tensorboardX psutil termcolor imageio tqdm) || exit 3
      "$python" -m pip install --quiet --no-deps robomimic
      "$python" "$readers/read_robomimic.py" "$work/robomimic.hdf5"
      ;;
    rlds)
      python=$(python_with rlds tensorflow-cpu tensorflow-datasets) || exit 3
      TF_CPP_MIN_LOG_LEVEL=3 "$python" "$readers/read_rlds.py" "$work/rlds" 2>/dev/null
      ;;
    *)
      echo "there is no reader $reader" >&2
      exit 2
      ;;
  esac
done
