#!/usr/bin/env bash
# Run time against error, and the plots and tables of docs/pareto.md: one command.
#   scripts/pareto.sh             measures on this machine's CPU and, where there is one, on its GPU, then draws
#   scripts/pareto.sh FILE.csv... measures nothing, and draws from these files of kdbench pareto, and from what docs/ has
# Figures of a device replace those that docs/ had of it: docs/pareto-cpu.csv, docs/pareto-cuda.csv.
# KD_PARETO sets options of kdbench pareto, such as "--size 480x270 --repeat 7 --threads 1".
cd "$(dirname "$0")/.."
. scripts/setup.sh

measure() {
  install_missing
  build kdbench
  [ -d ../shared/data ] || die "there are no meshes: ../shared/data is not there"
  say "Unpacking meshes to out/pareto"
  mkdir -p out/pareto
  local mesh device
  for mesh in sibenik sponza bunny dragon_res2 staircase living_room; do
    if [ -f "../shared/data/$mesh.ply" ]; then
      cp "../shared/data/$mesh.ply" out/pareto/
    elif [ -f "../shared/data/$mesh.ply.xz" ]; then
      xz -dc "../shared/data/$mesh.ply.xz" >"out/pareto/$mesh.ply"
    fi
  done
  local devices=(cpu)
  nvidia-smi >/dev/null 2>&1 && devices+=(cuda)
  for device in "${devices[@]}"; do
    say "Measuring on $device"
    # shellcheck disable=SC2086
    build/bin/kdbench pareto out/pareto/*.ply --cameras ../shared/data/cameras --device "$device" ${KD_PARETO:-} \
      --csv "docs/pareto-$device.csv" --json "out/pareto/$device.json" || die "kdbench pareto failed"
  done
}

# The device is the second column of each row.
take() {
  local file=$1 device
  device=$(sed -n 2p "$file" | cut -d, -f2)
  case $device in
    CPU*) device=cpu ;;
    CUDA*) device=cuda ;;
    *) die "$file is no CSV of kdbench pareto" ;;
  esac
  [ "$file" -ef "docs/pareto-$device.csv" ] || cp "$file" "docs/pareto-$device.csv"
}

if [ $# -eq 0 ]; then
  measure
else
  for file in "$@"; do take "$file"; done
fi

packages=(python3-matplotlib)
install_missing
say "Drawing"
/usr/bin/python3 scripts/pareto_plots.py || die "drawing failed"
ls -l docs/pareto* out/pareto/*.png
