#!/usr/bin/env bash
# run.sh PYTHON address|thread COMMAND...: build the core with sanitizers, apart from the installed
# one, and run a command of Python with it: run.sh .venv/bin/python thread -m pytest tests/...
# Fails if the command fails or a sanitizer reports anything, in whichever process.
set -euo pipefail
cd "$(dirname "$0")/../.."
root=$(pwd) here=$(pwd)/tests/sanitizers

fail() { echo "run.sh: $*" >&2; exit 2; }

[ $# -ge 3 ] || fail "PYTHON address|thread COMMAND... are needed"
python=$1 kind=$2
shift 2
case $python in /*) ;; *) python=$root/$python ;; esac
case $kind in
  address) flags=address,undefined,float-cast-overflow
    needed="libasan libubsan" packages="libasan8 libubsan1" ;;
  thread) flags=thread needed=libtsan packages=libtsan2 ;;
  *) fail "address or thread, not $kind" ;;
esac
[ "$(uname -s)" = Linux ] || fail "the sanitizers are preloaded as on Linux, not on $(uname -s)"
[ -x "$python" ] || fail "there is no $python: make setup"
export CXX=${CXX:-g++}
command -v "$CXX" >/dev/null || fail "there is no compiler $CXX: apt-get install g++"
built=$root/build/sanitize/$kind
mkdir -p "$built"

# A program of one line tells whether the runtimes are there, where, and whether they start.
echo 'int main() {}' >"$built/probe.cpp"
"$CXX" -fsanitize=$flags -Wl,--no-as-needed "$built/probe.cpp" -o "$built/probe" \
  2>"$built/probe.log" || {
  cat "$built/probe.log" >&2
  fail "$CXX has no runtime for $flags: apt-get install libgcc-$("$CXX" -dumpversion)-dev"
}
preload=
for library in $needed libstdc++; do
  path=$(ldd "$built/probe" | awk -v name="$library.so" 'index($1, name) == 1 { print $3 }')
  [ -e "$path" ] || fail "no shared $library for $CXX: apt-get install $packages (g++ is needed)"
  preload="$preload $path"
done
"$built/probe" || fail "programs with -fsanitize=$flags do not start here: \
if it is a memory mapping, sysctl vm.mmap_rnd_bits=28 helps"

# Ninja sees changed sources; another compiler, Python or nanobind needs a build anew.
nanobind=$("$python" -m nanobind --cmake_dir) || fail "there is no nanobind in $python"
made_with="$("$CXX" --version | head -n 1) $python $("$python" -VV) $nanobind $here"
[ "$(cat "$built/made_with" 2>/dev/null)" = "$made_with" ] || rm -rf "$built/cmake"
echo "$made_with" >"$built/made_with"

build() { # with cmake and ninja of Python's environment, if they are there
  PATH=$(dirname "$python"):$PATH cmake "$@" >"$built/build.log" 2>&1 ||
    { cat "$built/build.log" >&2; fail "the core cannot be built with -fsanitize=$flags"; }
}
build -S . -B "$built/cmake" -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo \
  -DTINSMITH_SANITIZE="$flags" -DPython_EXECUTABLE="$python" -Dnanobind_DIR="$nanobind"
build --build "$built/cmake"

# The package as it is installed, with these cores in place of others: links, as for the types.
rm -rf "$built/tree" && mkdir -p "$built/tree/tinsmith/tin" "$built/tree/tinsmith/terrain"
ln -s "$root"/src/tinsmith/* "$root/io" "$built/tree/tinsmith/"
for package in tin terrain; do
  ln -s "$root/$package"/* "$built/tree/tinsmith/$package/"
  rm -f "$built/tree/tinsmith/$package"/_core.*so
done
ln -s "$built"/cmake/_core.*so "$built/tree/tinsmith/tin/"
ln -s "$built"/cmake/terrain/_core.*so "$built/tree/tinsmith/terrain/"
cp "$here/sitecustomize.py" "$built/tree/"

# Reports go to files (UBSan's to stderr, after ASan's library): what dies in a child is seen, too.
rm -rf "$built/reports" && mkdir "$built/reports"
common=log_path=$built/reports/report:abort_on_error=1:halt_on_error=1
# No leaks: CPython frees little at exit, and to suppress what its frames are part of would suppress
# what the core allocates, too: Python calls the core.
export ASAN_OPTIONS=$common:allocator_may_return_null=1:detect_leaks=0
export UBSAN_OPTIONS=$common:print_stacktrace=1
# A test ends the interpreter while threads of the core are at work: nobody joins them then.
export TSAN_OPTIONS=$common:report_thread_leaks=0
export PYTHONPATH=$built/tree:$root/tests PYTHONMALLOC=malloc

loaded=$(LD_PRELOAD=$preload "$python" -c "from tinsmith.tin import _core; print(_core.__file__)") ||
  fail "Python does not start with the core that was built"
[ "${loaded#"$built"}" != "$loaded" ] || fail "Python took another core: $loaded"

status=0 shown=0
LD_PRELOAD=$preload "$python" "$@" || status=$?
for report in "$built"/reports/*; do # a campaign makes a find small, with a report at each step
  [ -e "$report" ] || continue
  status=1 shown=$((shown + 1))
  [ $shown -gt 3 ] || cat "$report" >&2
done
[ $shown = 0 ] || echo "run.sh: $shown reports in $built/reports" >&2
exit $status
