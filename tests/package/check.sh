#!/usr/bin/env bash
# check.sh BUILD: installs BUILD, builds user.cpp against the copy, and runs a scene with it and with the installed
# program: the two must tell the same number to the last bit. Every installed header must compile by itself.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
build=$(cd "$1" && pwd)
folder=$build/package-check
rm -rf "$folder"
cmake --install "$build" --prefix "$folder/prefix" >/dev/null
cmake -S "$here" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$folder/prefix" >/dev/null
cmake --build "$folder/build"

include=$folder/prefix/include/grandamp
headers=$(cd "$include" && find . -name '*.hpp' | sed 's|^\./||')
[ -n "$headers" ]
for header in $headers; do
  echo "#include \"$header\"" | c++ -std=c++20 -fsyntax-only -I"$include" -x c++ -
done

from_library=$("$folder/build/user" "$here/scene.toml")
"$folder/prefix/bin/grandamp" run "$here/scene.toml" -o "$folder/run" --quiet
python3 - "$from_library" "$folder/run/summary.json" <<'END'
import json, sys
library = float(sys.argv[1])
program = json.load(open(sys.argv[2]))["structure"]["rms_displacement"]
print(f"rms displacement: {library!r} m from the library, {program!r} m from the program")
sys.exit(0 if library == program and library > 0.0 else 1)
END
