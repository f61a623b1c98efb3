#!/usr/bin/env bash
# On a GPU machine, from the project's root with dist/ (scripts/dist.sh) beside it: the parity test, 10^8 adversarial rays
# (KD_STRESS_RAYS) against exact integers, the demo render, traversal on the shared rays, exact and with float tests,
# run time against error, and cost against what a scene holds. Figures go to the folder named, as JSON and CSV.
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
$bin/kdbench stress --rays "${KD_STRESS_RAYS:-100000000}" --device cuda --quiet --json "$out/stress.json" >"$out/stress.txt" || stress=$?
tail -4 "$out/stress.txt"

echo "== demo"
cp data/cathedral.json dist/
for device in cuda cpu; do
  $bin/kdrender dist/cathedral.json -o "$out/cathedral-$device.exr" --device $device --stats "$out/cathedral-$device.json"
done
$bin/kdrender dist/cathedral.json --device cuda --compare "$out/cathedral-cpu.exr" | tail -1

echo "== the paper's frame: one object, one light, ambient, diffuse, shadow and gamma, 1920 x 1080"
cp data/sibenik_paper.json dist/
cp dist/objects/sibenik.nkd dist/compiled/
$bin/kdbench frame dist/sibenik_paper.json --device cuda --gamma-exr
for run in 1 2 3 4 5; do
  /usr/bin/time -f "process %e s" $bin/kdrender dist/sibenik_paper.json -o "$out/paper.exr" --gamma-exr --device cuda --quiet \
    --stats "$out/paper.json"
  tr -d '\n ' <"$out/paper.json" | grep -o '"seconds":{[^}]*}'
done
$bin/kdrender dist/sibenik_paper.json -o "$out/paper-cpu.exr" --gamma-exr --device cpu --quiet
$bin/kdrender dist/sibenik_paper.json --gamma-exr --device cuda --compare "$out/paper-cpu.exr" | tail -1

echo "== from the paper's dense pipeline to ours, step by step"
for scene in sibenik_paper cathedral; do
  $bin/kdbench paper dist/$scene.json --device cuda --gamma-exr --json "$out/steps-$scene.json" >"$out/steps-$scene.md"
  cat "$out/steps-$scene.md"
done

meshes="sibenik sponza bunny dragon_res2 staircase living_room"
echo "== traversal, 1920 x 1080, and what exactness costs: the same kernel with the usual float tests; compact triangles"
for mesh in $meshes; do
  $bin/kdbench trace dist/objects/$mesh.nkd --camera dist/shared/data/cameras/$mesh.txt --device cuda --repeat 20 --json "$out/trace-$mesh.json"
  for test in exact moller-trumbore woop; do
    $bin/kdbench trace dist/objects/$mesh.nkd --camera dist/shared/data/cameras/$mesh.txt --device cuda --repeat 20 --triangle-test $test \
      --scattered none --json "$out/trace-$mesh-$test.json"
  done
  $bin/kdbench trace dist/objects/$mesh.nkd --camera dist/shared/data/cameras/$mesh.txt --device cuda --repeat 20 --layout compact \
    --json "$out/trace-$mesh-compact.json"
done

echo "== the floor: instructions and bytes, the chip's rates, and what was measured"
$bin/kdbench floor $(printf 'dist/objects/%s.nkd ' $meshes) --cameras dist/shared/data/cameras --device cuda --repeat 20 \
  --json "$out/floor.json" >"$out/floor.md"
cat "$out/floor.md"

echo "== run time against error"
$bin/kdbench pareto $(printf 'dist/shared/data/%s.ply ' $meshes) --size 1920x1080 --device cuda --csv "$out/pareto-cuda.csv" --json "$out/pareto-cuda.json" \
  >"$out/pareto.md"

echo "== cost against what a scene holds and shows"
$bin/kdbench scale --device cuda --size 1920x1080 --json "$out/scale.json" >"$out/scale.md"
cat "$out/scale.md"

echo "== a thousand million triangles of instances, 1920 x 1080"
for scene in forest city; do
  $bin/kdbench $scene -o dist/$scene
  $bin/kdbuild build dist/$scene/meshes/*.obj -o dist/$scene/compiled/ --quiet
  $bin/kdrender dist/$scene/$scene.json -o "$out/$scene.exr" --preview "$out/$scene.png" --device cuda --stats "$out/$scene.json"
  $bin/kdbench frame dist/$scene/$scene.json --device cuda
  $bin/kdrender dist/$scene/$scene.json -o "$out/$scene-cpu.exr" --device cpu --quiet
  $bin/kdrender dist/$scene/$scene.json --device cuda --compare "$out/$scene-cpu.exr" | tail -1
done
# So large that rays can meet a thousand million triangles of it.
$bin/kdbench city -o dist/metropolis --triangles 2800000000 | tail -1
rm -r dist/metropolis/compiled && ln -s ../city/compiled dist/metropolis/compiled
$bin/kdrender dist/metropolis/city.json -o "$out/metropolis.exr" --device cuda --stats "$out/metropolis.json"
$bin/kdbench frame dist/metropolis/city.json --device cuda
exit $stress
