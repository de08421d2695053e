# Sourced by what needs a window: a virtual display with software Vulkan.

# Starts a display of this size, or of 1024x768, and waits until it answers; sets DISPLAY, and display to its process.
start_display() {
  local number=99
  while [[ -e /tmp/.X$number-lock ]]; do number=$((number + 1)); done
  export DISPLAY=:$number XDG_RUNTIME_DIR=${XDG_RUNTIME_DIR:-/tmp} WGPU_BACKEND=vulkan
  Xvfb "$DISPLAY" -screen 0 "${1:-1024x768}x24" -nolisten tcp >/dev/null 2>&1 &
  display=$!
  until xdotool getdisplaygeometry >/dev/null 2>&1; do
    kill -0 "$display" 2>/dev/null || { echo "Xvfb cannot start display $DISPLAY" >&2; return 1; }
    sleep 0.1
  done
}
