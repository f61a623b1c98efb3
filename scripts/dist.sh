#!/usr/bin/env bash
# A relocatable tree in dist/ for a GPU machine that has none of our libraries: the tools, the benchmark, the parity test,
# their shared libraries, and the meshes of ../shared/data if it is there. scripts/gpu.sh is what to run on that machine.
#   scripts/dist.sh [ARCHITECTURES]    e.g. 90 (default), "80;90"
cd "$(dirname "$0")/.."
. scripts/setup.sh

install_missing
command -v nvcc >/dev/null || die "nvcc is not on the PATH"
say "Building for sm_${1:-90}"
# Without Embree: builds are compared where meshes are compiled, and its library has 44 MB.
cmake -S . -B build-dist -G Ninja -DCMAKE_BUILD_TYPE=Release -DKD_CUDA=ON -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON "-DKD_CUDA_ARCHITECTURES=${1:-90}" \
  -DCMAKE_EXE_LINKER_FLAGS=-Wl,--disable-new-dtags '-DCMAKE_BUILD_RPATH=$ORIGIN/../lib' >/dev/null || die "configuring failed"
cmake --build build-dist --target kdbuild kdrender kdbench test_parity || die "building failed"

rm -rf dist
mkdir -p dist/bin dist/lib dist/shared/data
cp build-dist/bin/{kdbuild,kdrender,kdbench,test_parity} dist/bin/
strip dist/bin/*
ldd dist/bin/* | awk '$3 ~ /^\// {print $3}' | sort -u | grep -vE '/(libc|libm|libdl|librt|libpthread|libstdc\+\+|libgcc_s|ld-linux[^/]*)\.so' |
  xargs -I{} cp -L {} dist/lib/
if [ -d ../shared/data ]; then
  cp -r ../shared/data/cameras ../shared/data/*.ply dist/shared/data/
  for packed in ../shared/data/*.ply.xz; do xz -dc "$packed" >"dist/shared/data/$(basename "${packed%.xz}")"; done
fi
say "dist/ is ready: $(du -sh dist | cut -f1)"
