#!/usr/bin/env bash
# Installs what the tests need, builds, and runs every test; the last line is the sum: "N passed, N failed".
#   bash tests/run.sh          about 25 minutes on two cores, or more where they are shared
#   bash tests/run.sh --full   the long forms too, and every test under the sanitizers
# What each check printed is in build/checks/.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
source io/packages.sh

full=0
case "${1-}" in
  "") ;;
  --full) full=1 ;;
  *) echo "usage: bash tests/run.sh [--full]" >&2; exit 2 ;;
esac
[ $full -eq 1 ] && export GRANDAMP_FULL=1
fuzz_seconds=60
# Without --full: the folders whose tests reach every line; the long runs of the others only repeat them.
sanitized='^(kernels|solver|io)/'
# The long hard cases would take days: 10^9 granule-steps of them are run by themselves.
[ $full -eq 1 ] && sanitized='^(kernels|solver|io|physics|exactness)/'

jobs=$(nproc)
logs=build/checks
passed=0 failed=0 failures=()
mkdir -p $logs

finish() {
  [ ${#failures[@]} -gt 0 ] && printf 'failed: %s\n' "${failures[@]}"
  echo "$passed passed, $failed failed"
  [ "$failed" -eq 0 ] && [ "$passed" -gt 0 ]
  exit
}

# check NAME COMMAND...: one test that is a script.
check() {
  local name=$1 start=$SECONDS
  shift
  if "$@" >"$logs/$name.log" 2>&1; then
    passed=$((passed + 1))
    echo "ok      $name ($((SECONDS - start)) s)"
  else
    failed=$((failed + 1))
    failures+=("$name ($logs/$name.log)")
    echo "FAILED  $name ($((SECONDS - start)) s)"
    tail -n 40 "$logs/$name.log"
    return 1
  fi
}

# need NAME COMMAND...: without it nothing further makes sense.
need() {
  check "$@" || finish
}

# build PRESET [OPTION]... ; targets=(NAME...): these alone.
build() { cmake --preset "$@" && cmake --build --preset "$1" -j "$jobs" ${targets[@]+--target "${targets[@]}"}; }

# cases NAME BUILD PATTERN: the doctest cases of a build whose names match. All of them must be known to ctest.
cases() {
  local name=$1 folder=$2 pattern=$3 start=$SECONDS counts known here program report=$logs/$1.xml
  rm -f "$report"
  here=0
  for program in "$folder"/tests/test_*; do
    [ -f "$program" ] && [ -x "$program" ] || continue
    here=$((here + $("$program" --count --no-version | sed -n 's/.*test cases.*: *\([0-9]*\)$/\1/p')))
  done
  known=$(ctest --test-dir "$folder" --show-only | grep '^ *Test *#' | grep -vc '_NOT_BUILT')
  if [ "$here" != "$known" ]; then
    failed=$((failed + 1))
    failures+=("$name: the executables hold $here cases, ctest knows ${known:-none}; a name has a semicolon or a bracket?")
  fi
  ctest --test-dir "$folder" -j "$jobs" -R "$pattern" --no-tests=error --output-on-failure \
    --output-junit "$PWD/$report" >"$logs/$name.log" 2>&1
  counts=$(sed -n '/<testsuite /,/>/p' "$report" 2>/dev/null | tr '\n\t' '  ')
  local total bad skipped
  total=$(sed -n 's/.* tests="\([0-9]*\)".*/\1/p' <<<"$counts")
  bad=$(sed -n 's/.* failures="\([0-9]*\)".*/\1/p' <<<"$counts")
  skipped=$(sed -n 's/.* disabled="\([0-9]*\)".* skipped="\([0-9]*\)".*/\1 \2/p' <<<"$counts" | awk '{print $1 + $2}')
  if [ "${total:-0}" -eq 0 ]; then
    failed=$((failed + 1))
    failures+=("$name: no tests were run ($logs/$name.log)")
    return
  fi
  bad=$((bad + skipped))
  passed=$((passed + total - bad))
  failed=$((failed + bad))
  echo "$([ "$bad" -eq 0 ] && echo "ok    " || echo FAILED)  $name: $((total - bad)) of $total cases ($((SECONDS - start)) s)"
  if [ "$bad" -gt 0 ]; then
    sed -n '/The following tests FAILED/,$p' "$logs/$name.log"
    grep -B 2 -A 12 'ERROR' "$logs/$name.log" | head -n 200
    failures+=("$name: $bad ($logs/$name.log)")
  fi
}

format() {
  git ls-files -co --exclude-standard -- '*.cpp' '*.hpp' | xargs -r ls -d 2>/dev/null | xargs clang-format-14 --dry-run -Werror
}

# They are built last; a mistake in one should not take an hour to show.
fuzz_syntax() {
  local source
  for source in tests/fuzz/*_fuzz.cpp; do
    clang++-14 -std=c++20 -fsyntax-only -I. -isystem /usr/include/hdf5/serial -isystem /usr/include/eigen3 "$source" || return
  done
}

fuzz() {
  local name=$1 found=$PWD/build-fuzz/found/$1
  mkdir -p "$found/corpus"
  "build-fuzz/tests/fuzz/$name" -max_total_time=$fuzz_seconds -timeout=20 -rss_limit_mb=3000 -print_final_stats=1 \
    -artifact_prefix="$found/" "$found/corpus" "tests/fuzz/${name%_fuzz}_corpus"
}

# All fuzz targets at once: each works on one processor.
fuzz_all() {
  local source name
  local -A running
  for source in tests/fuzz/*_fuzz.cpp; do
    name=$(basename "$source" .cpp)
    fuzz "$name" >"$logs/$name.out" 2>&1 &
    running[$name]=$!
  done
  for name in "${!running[@]}"; do
    check "$name" finished "${running[$name]}" "$logs/$name.out"
  done
}
finished() {
  local status=0
  wait "$1" || status=$?
  cat "$2"
  return "$status"
}

[ $full -eq 1 ] && test_packages=("${full_test_packages[@]}")
need packages install_packages "${test_packages[@]}"
check layering bash tests/layering/check.sh
check format format
check fuzz_syntax fuzz_syntax
need build_release build release -DGRANDAMP_TESTS=ON -DGRANDAMP_BENCHES=ON
cases tests build .
check package bash tests/package/check.sh build
check report bash tests/report/check.sh build $logs/report
[ $full -eq 1 ] && check slurm bash tests/slurm/check.sh build/grandamp
# The paper: all of it takes as long as all the rest, so without --full what one contact and a gas do.
paper=(fig2 fig6 fig7 fig8)
[ $full -eq 1 ] && paper=()
check paper env GRANDAMP_PAPER_RESULTS="$PWD/$logs/paper" bash tests/paper/run.sh "${paper[@]}"
if [ "$(uname -m)" = x86_64 ]; then
  check portable_symbols bash tests/portability/check_symbols.sh build
  check old_processor bash tests/portability/check_old_processor.sh build
fi
check tidy bash tests/tidy/check.sh build
targets=(grandamp_program test_kernels test_solver test_io)
[ $full -eq 1 ] && targets=()
check build_sanitize build sanitize && cases sanitized build-sanitize "$sanitized"
targets=()
if [ $full -eq 1 ]; then
  check hard_cases_sanitized env -u GRANDAMP_FULL GRANDAMP_GRANULE_STEPS=1e9 \
    build-sanitize/tests/test_hard_cases --test-case='*as many granule-steps*'
  check build_thread_sanitize build thread-sanitize
  # On one processor TBB, which makes the packings and was not built for the sanitizer, starts no threads; the solver's
  # own are as many as the tests ask for.
  check thread_sanitizer env TSAN_OPTIONS=halt_on_error=1 taskset -c "$(taskset -cp $$ | sed 's/.*[:,-] *//')" \
    build-thread-sanitize/tests/test_solver --test-case='the same bits*,cut between*'
fi
need build_fuzz build fuzz
fuzz_all
finish
