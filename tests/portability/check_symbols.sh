#!/usr/bin/env bash
# check_symbols.sh BUILD: an inline function compiled with AVX flags, if it is not of that instruction set by its name,
# may be the copy that the linker keeps for everybody, and stop the program on an older machine. So the objects of an
# instruction set may define none, and no two of different flags may define the same.
set -uo pipefail
status=0
folder=$(find "$1" -type d -path '*grandamp.dir/kernels' | head -n 1)
weak() { nm --defined-only -f posix "$@" 2>/dev/null | awk '$2 == "W" {print $1}' | sort -u; } # W: functions; V, u: data

avx2=$(ls "$folder"/kernels_avx2*.o) && avx512=$(ls "$folder"/kernels_avx512*.o) || exit 1
# shellcheck disable=SC2086
for objects in "$avx2" "$avx512"; do
  leaks=$(weak $objects | grep -viE 'avx|fma3' | c++filt)
  if [ -n "$leaks" ]; then
    printf 'not bound to an instruction set, in %s:\n%s\n' "$objects" "$leaks"
    status=1
  fi
done
# shellcheck disable=SC2086
both=$(comm -12 <(weak $avx2) <(weak $avx512) | c++filt)
if [ -n "$both" ]; then
  printf 'in both the AVX2 and the AVX-512 objects:\n%s\n' "$both"
  status=1
fi
exit $status
