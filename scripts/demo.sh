#!/usr/bin/env bash
# From nothing to a picture: installs what is missing, builds, compiles the meshes in data/, renders the demo scene.
cd "$(dirname "$0")/.."
. scripts/setup.sh

install_missing
build kdbuild kdrender

say "Compiling the meshes in data/"
mkdir -p out
build/bin/kdbuild build data/*.obj data/*.ply -o data/compiled/ --quiet || die "kdbuild failed"

say "Rendering data/cathedral.json"
build/bin/kdrender data/cathedral.json -o out/cathedral.exr --preview out/cathedral.png || die "kdrender failed"

cat <<'END'

The pictures: out/cathedral.png to look at, out/cathedral.exr scene-linear.

What to try next:
  build/bin/kdrender data/spheres.json -o out/spheres.exr --preview out/spheres.png --aov depth,normal
  build/bin/kdbuild build YOUR_MESH.obj -o data/compiled/mesh.nkd    # OBJ, PLY, STL, OFF or glTF
  build/bin/kdbuild info data/compiled/mesh.nkd
  then place it: copy data/spheres.json, name the object, and render
END
