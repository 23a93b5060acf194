#!/usr/bin/env bash
# clang-tidy over kernels/, solver/ and io/. Most of its time goes into the libraries' headers, so it looks at a dozen
# sources in one unit; sources that do not compile together, two having a name in common, are looked at one by one.
#   bash tests/tidy/check.sh BUILD   BUILD: a configured build folder, with each source's own command
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 2
build=${1:?usage: bash tests/tidy/check.sh BUILD}
[ -f "$build/compile_commands.json" ] || { echo "tests/tidy/check.sh: '$build': no compile_commands.json; BUILD is a configured build folder" >&2; exit 2; }
together=build-tidy
jobs=$(nproc)

# The units of the instruction sets instantiate the same templates; two of them stand for all.
left_out='/kernels_(generic|avx512|avx2_(candidates|none|energies|ledger\.))'

# look FOLDER FILE [OPTION]...: FOLDER has the compile command. What is found is told once the file is done.
look() {
  local folder=$1 file=$2 found status=0
  shift 2
  found=$(clang-tidy-14 -p "$folder" -quiet "$@" "$file" 2>&1) || status=$?
  [ $status -eq 0 ] || printf '%s\n' "$file" "$found" | grep -v ' warnings generated\.$'
  return $status
}
sources_of() { sed -n 's/^#include "\(.*\.cpp\)"$/\1/p' "$@"; }
# look_at FILE: a source, or a unit of many.
look_at() {
  case $1 in
    "$together"/*) ;;
    *) look "$build" "$1"; return ;;
  esac
  look $together "$1" -checks=-bugprone-suspicious-include -extra-arg=-Wno-shadow >/dev/null && return
  echo "one by one: $1"
  local source status=0
  for source in $(sources_of "$1"); do look "$build" "$source" || status=1; done
  return $status
}
export -f look look_at sources_of
export build together

rm -rf $together
cmake -S . -B $together -G Ninja -DCMAKE_BUILD_TYPE=Release -DGRANDAMP_TESTS=OFF \
  -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=12 >/dev/null || exit
mapfile -t units < <(find $together/CMakeFiles -path '*/Unity/unity_*' | sort)
mapfile -t alone < <(sed -n 's|^ *"file": "\(.*\.cpp\)".*|\1|p' "$build"/compile_commands.json |
  grep -E "^$PWD/(kernels|solver|io)/" | grep -vxFf <(sources_of "${units[@]}") | grep -vE "$left_out" | sort)
echo "${#units[@]} units, ${#alone[@]} sources by themselves"
[ ${#units[@]} -gt 0 ] && [ ${#alone[@]} -gt 0 ] || exit

# misc-unused-using-decls looks at no source that is included.
status=0
for source in kernels/*.cpp solver/*.cpp io/*.cpp io/commands/*.cpp; do
  for name in $(sed -n 's/^ *using [a-zA-Z0-9_:]*::\([a-zA-Z0-9_]*\);.*/\1/p' "$source"); do
    if [ "$(grep -cw "$name" "$source")" -lt 2 ]; then
      echo "$source: $name is declared by 'using' and not used"
      status=1
    fi
  done
done

printf '%s\0' "${alone[@]}" "${units[@]}" | xargs -0 -P "$jobs" -I{} bash -c 'look_at "$1"' _ {} || status=1
exit $status
