#!/usr/bin/env bash
# What a scene costs as it grows, and the plots and tables of docs/scale.md: one command.
#   scripts/scale.sh              measures on this machine's CPU and, where there is one, on its GPU, then draws
#   scripts/scale.sh FILE.json... measures nothing, and draws from these reports of kdbench scale, and from what docs/ has
# Figures of a device replace those that docs/ had of it: docs/scale-cpu.json, docs/scale-cuda.json.
# KD_SCALE sets options of kdbench scale, such as "--size 480x270 --repeat 7".
cd "$(dirname "$0")/.."
. scripts/setup.sh

measure() {
  install_missing
  build kdbench
  local devices=(cpu) device
  nvidia-smi >/dev/null 2>&1 && devices+=(cuda)
  for device in "${devices[@]}"; do
    say "Measuring on $device"
    # shellcheck disable=SC2086
    build/bin/kdbench scale --device "$device" ${KD_SCALE:-} --json "docs/scale-$device.json" || die "kdbench scale failed"
  done
}

take() {
  local file=$1 device
  device=$(grep -o '"device": "[A-Z]*' "$file" | head -1)
  case $device in
    *CPU) device=cpu ;;
    *CUDA) device=cuda ;;
    *) die "$file is no report of kdbench scale" ;;
  esac
  [ "$file" -ef "docs/scale-$device.json" ] || cp "$file" "docs/scale-$device.json"
}

if [ $# -eq 0 ]; then
  measure
else
  for file in "$@"; do take "$file"; done
fi

packages=(python3-matplotlib)
install_missing
say "Drawing"
/usr/bin/python3 scripts/scale_plots.py || die "drawing failed"
ls -l docs/scale*
