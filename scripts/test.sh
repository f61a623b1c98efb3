#!/usr/bin/env bash
# The same set-up as demo.sh, then all tests.
cd "$(dirname "$0")/.."
. scripts/setup.sh

install_missing
build

say "Testing"
ctest --preset release || die "tests failed"
