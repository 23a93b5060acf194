#!/usr/bin/env bash
# check_old_processor.sh BUILD: the program on a processor without AVX (Nehalem, 2008) picks the generic kernels by
# itself, runs a scene, and agrees with the generic kernels on this machine.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=$1/grandamp
folder=$1/old-processor-check
rm -rf "$folder"
mkdir -p "$folder"
qemu-x86_64 -cpu Nehalem "$program" --version
qemu-x86_64 -cpu Nehalem "$program" run "$here/../package/scene.toml" -o "$folder/old" --quiet --set time.duration=0.02
"$program" run "$here/../package/scene.toml" -o "$folder/here" --quiet --set time.duration=0.02 --isa generic
python3 - "$folder/old/summary.json" "$folder/here/summary.json" <<'END'
import json, sys
old, here = (json.load(open(name)) for name in sys.argv[1:])
a, b = (s["structure"]["rms_displacement"] for s in (old, here))
print(f"rms displacement: {a!r} m ({old['isa']}, Nehalem), {b!r} m ({here['isa']}, here)")
# libm's sine and exponential may round differently there, and 0.02 s is too short for that to grow.
sys.exit(0 if old["isa"] == here["isa"] == "generic" and b > 0.0 and abs(a - b) <= 1e-9 * b else 1)
END
