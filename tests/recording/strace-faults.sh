#!/usr/bin/env bash
# Lets system calls of a recording fail from outside, with strace, and verifies what is left of it.
# Usage: strace-faults.sh PROGRAM [EVERY]: PROGRAM is the built tabletop; of each system call, every EVERY-th (17) fails.
set -euo pipefail
program=$(realpath "$1")
every=${2:-17}
command -v strace >/dev/null || { echo "strace is not installed: nothing was tried"; exit 0; }
place=$(mktemp -d)
trap 'rm -rf "$place"' EXIT
cat >"$place/undo.ron" <<'END'
(setup: "shipped:tablesetup/default.xml", steps: [
  Start, Grasp("RedBlock"), MoveTo((-1.5, 0.2, 5)), Wait(0.2), Release, Wait(0.1), Undo, Undo, Wait(0.1), Redo, Redo, Wait(0.1),
  Undo, Grasp("GreenBlock"), Wait(0.3), Undo, Wait(0.3), Finish,
])
END
record=("$program" run "$place/undo.ron" --quiet --record "$place/demo")
tried=0
for call in write ftruncate rename mkdir openat unlink; do
  rm -rf "$place"/demo*
  strace -f -c -e "trace=$call" -o "$place/count" "${record[@]}"
  count=$(awk -v call="$call" '$NF == call { print $4 }' "$place/count")
  for ((n = 1; n <= ${count:-0}; n += every)); do
    for fault in error=ENOSPC error=EIO signal=KILL; do
      rm -rf "$place"/demo*
      (strace -f -qq -o /dev/null -e "trace=$call" -e "inject=$call:$fault:when=$n" "${record[@]}" || true) >/dev/null 2>&1
      tried=$((tried + 1))
      [[ -e $place/demo ]] || continue
      "$program" replay "$place/demo" --verify 2>"$place/said" ||
        { echo "$call $n, $fault: $(cat "$place/said")"; exit 1; }
    done
  done
done
echo "$tried faults, and what was left replays"
