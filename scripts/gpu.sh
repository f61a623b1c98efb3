#!/usr/bin/env bash
# On a GPU machine, from the project's root with dist/ (scripts/dist.sh) beside it: the parity test, 10^8 adversarial rays
# against exact integers, the demo render, and traversal on the shared rays. Figures go to the folder named, as JSON.
#   scripts/gpu.sh [FOLDER]
cd "$(dirname "$0")/.."
set -eu
out=${1:-out/gpu}
mkdir -p "$out" dist/objects dist/compiled
bin=dist/bin
nvidia-smi --query-gpu=name,driver_version,clocks.sm --format=csv,noheader

for mesh in data/*.obj data/*.ply; do $bin/kdbuild build "$mesh" -o "dist/compiled/$(basename "${mesh%.*}").nkd" --quiet; done
for mesh in dist/shared/data/*.ply; do $bin/kdbuild build "$mesh" -o "dist/objects/$(basename "${mesh%.*}").nkd" --quiet; done

echo "== parity"
KD_SOURCE_DIR=$PWD KD_SHARED_DIR=$PWD/dist/shared/data $bin/test_parity 2>&1 | tee "$out/parity.log" | grep -vE '^$|^=|doctest\] (doctest|run)|TEST CASE'

echo "== stress"
stress=0
$bin/kdbench stress --rays 100000000 --device cuda --quiet --json "$out/stress.json" >"$out/stress.txt" || stress=$?
tail -4 "$out/stress.txt"

echo "== demo"
cp data/cathedral.json dist/
for device in cuda cpu; do
  $bin/kdrender dist/cathedral.json -o "$out/cathedral-$device.exr" --device $device --stats "$out/cathedral-$device.json"
done
cmp "$out/cathedral-cuda.exr" "$out/cathedral-cpu.exr" && echo "cathedral: the same EXR bytes"

echo "== traversal, 1920 x 1080"
for mesh in sibenik sponza bunny dragon_res2 staircase living_room; do
  $bin/kdbench trace dist/objects/$mesh.nkd --camera dist/shared/data/cameras/$mesh.txt --device cuda --repeat 20 --json "$out/trace-$mesh.json"
done
exit $stress
