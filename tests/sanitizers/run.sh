#!/usr/bin/env bash
# run.sh PYTHON address|thread COMMAND...: build the core with sanitizers, apart from the installed
# one, and run a command of Python with it: run.sh .venv/bin/python thread -m pytest tests/...
set -euo pipefail
cd "$(dirname "$0")/../.."
python=$(pwd)/$1 kind=$2
shift 2
case $kind in
  address) flags=address,undefined library=libasan.so ;;
  thread) flags=thread library=libtsan.so ;;
  *) echo "run.sh: address or thread, not $kind" >&2; exit 2 ;;
esac
built=$(pwd)/build/sanitize/$kind
here=$(pwd)/tests/sanitizers

# The package as it is installed, with this core in place of the other: links, as for the types.
rm -rf "$built/tree" && mkdir -p "$built/tree/tinsmith/tin" "$built/cmake"
ln -s "$(pwd)"/src/tinsmith/* "$(pwd)/io" "$(pwd)/terrain" "$built/tree/tinsmith/"
ln -s "$(pwd)"/tin/* "$built/tree/tinsmith/tin/"
cp "$here/sitecustomize.py" "$built/tree/"

path=$(dirname "$python"):$PATH
PATH=$path cmake -S . -B "$built/cmake" -G Ninja -DCMAKE_BUILD_TYPE=Release \
  -DTINSMITH_SANITIZE="$flags" -DPython_EXECUTABLE="$python" \
  -Dnanobind_DIR="$("$python" -m nanobind --cmake_dir)" >"$built/cmake.log"
PATH=$path cmake --build "$built/cmake" >"$built/build.log" || { cat "$built/build.log"; exit 1; }
ln -s "$built"/cmake/_core.*so "$built/tree/tinsmith/tin/"

# Leaks are not looked for: CPython and its extension modules free little at exit.
export ASAN_OPTIONS=detect_leaks=0:allocator_may_return_null=1:abort_on_error=1
export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$here/thread.supp:halt_on_error=1:abort_on_error=1:exitcode=66
export PYTHONPATH=$built/tree:$(pwd)/tests PYTHONMALLOC=malloc TINSMITH_SANITIZED=$kind
library=$("${CXX:-g++}" -print-file-name=$library)
cxx=$("${CXX:-g++}" -print-file-name=libstdc++.so.6)
LD_PRELOAD="$library $cxx" exec "$python" "$@"
