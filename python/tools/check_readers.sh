#!/usr/bin/env bash
# Exports recordings to every format, and lets the tools' own readers read them: check_readers.sh [light] [octave] [rerun] [lerobot] [robomimic] [rlds].
# With TABLETOP_RECORDINGS=FOLDER, the readers light, octave and lerobot read what each recording in that folder is exported to, too.
# Ends with 3 if a reader cannot be installed. Each reader gets a Python environment of its own below ~/.cache/tabletop/readers, made with pip; lerobot takes half an hour the first time.
set -euo pipefail
cd "$(dirname "$0")/../.."
program=${TABLETOP:-${CARGO_TARGET_DIR:-target}/release/tabletop}
environments=${XDG_CACHE_HOME:-$HOME/.cache}/tabletop/readers
readers=python/tools/readers
work=$(mktemp -d)
trap 'rm -r "$work"' EXIT
(($#)) || set -- light octave rerun lerobot robomimic rlds

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
"$program" export "$work/many" --to lerobot "$work/lerobot" >/dev/null
"$program" export "$work/many" --to lerobot "$work/lerobot_video" --video --fps 10 --size 96x72 >/dev/null
"$program" export "$work/many" --to robomimic "$work/robomimic.hdf5" >/dev/null
"$program" export "$work/many" --to rlds "$work/rlds" >/dev/null
"$program" export "$work/many" --to mcap "$work/mcap" >/dev/null
"$program" export "$work/many" --to mat "$work/mat" >/dev/null

# Sets of one recording each; what cannot be exported has no file there.
kinds=()
if [[ -n ${TABLETOP_RECORDINGS:-} ]]; then
  for recording in "$TABLETOP_RECORDINGS"/*/; do
    kind=$work/kinds/$(basename "$recording")
    [[ -e $recording/0.txt ]] || continue
    mkdir -p "$kind"
    kinds+=("$kind")
    ln -s "$(realpath "$recording")" "$kind/recording"
    for target in lerobot robomimic.hdf5 rlds mcap mat; do
      "$program" export "$recording" --to "${target%.*}" "$kind/$target" >/dev/null 2>"$kind/refusal" ||
        echo "$(basename "$recording") to ${target%.*} is refused: $(tail -1 "$kind/refusal")"
    done
  done
  ((${#kinds[@]})) || { echo "$TABLETOP_RECORDINGS has no recordings" >&2; exit 2; }
fi

for reader in "$@"; do
  echo "== $reader"
  case $reader in
    light)
      python=$(python_with light h5py pyarrow mcap mcap-protobuf-support foxglove-schemas-protobuf) || exit 3
      "$python" "$readers/read_light.py" "$work" "${kinds[@]}"
      ;;
    rerun)
      python=$(python_with rerun rerun-sdk) || exit 3
      "$python" "$readers/read_rerun.py" "$work/mcap/episode-000000.mcap"
      ;;
    octave)
      for file in "$work"/mat/episode-000000.mat "${kinds[@]/%//mat/episode-000000.mat}"; do
        [[ -e $file ]] || continue
        octave --quiet --eval "e = load('$file'); assert(size(e.head_image, 3), 3);
          assert(size(e.state, 1), size(e.head_image, 4)); printf('Octave %s: %d frames, %s\n', version, size(e.state, 1), char(e.task));"
      done
      ;;
    lerobot)
      python=$(python_with lerobot 'lerobot[dataset]') || exit 3
      "$python" "$readers/read_lerobot.py" "$work/lerobot" "${recordings[@]}"
      "$python" "$readers/read_lerobot.py" "$work/lerobot_video" "${recordings[@]}"
      for kind in "${kinds[@]}"; do
        [[ ! -e $kind/lerobot ]] || "$python" "$readers/read_lerobot.py" "$kind/lerobot" "$kind/recording"
      done
      # What LeRobot's own tools have edited is read, merged and added to.
      for set in lerobot lerobot_video; do
        "$python" "$readers/edit_lerobot.py" "$work/$set" "$work/$set.edited"
        for part in delete train valid merge; do
          "$program" dataset check "$work/$set.edited/$part" >/dev/null
        done
        "$program" dataset merge "$work/$set.edited/train" "$work/$set.edited/valid" --out "$work/$set.edited/all" >/dev/null
        "$python" "$readers/read_lerobot.py" "$work/$set.edited/all" "${recordings[@]}"
      done
      # What is done to videos and to PNG files gives the same frames.
      "$program" export "$work/many" --to lerobot "$work/lerobot_small" --fps 10 --size 96x72 >/dev/null
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
