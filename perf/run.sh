#!/usr/bin/env bash
# Builds the release and measures. Tables and pictures go to perf/results/, or GRANDAMP_PERF_RESULTS.
#   perf/run.sh kernels        each kernel by itself, for each instruction set
#   perf/run.sh scenes         S1 to S5, this program alone
#   perf/run.sh peers          S1 to S5, in turn with LAMMPS and LIGGGHTS
#   perf/run.sh sizes          100 to 10,000,000 granules: time and memory
#   perf/run.sh radii          granules of unlike sizes, up to 1 : 20
#   perf/run.sh threads        1, 2, ... threads
#   perf/run.sh paper_table4   the paper's contact searches, Table 4 and Fig. 13
#   perf/run.sh paper_fig14    intervals between lists, Fig. 14
#   perf/run.sh effects        what each effect costs, in time and in instructions
#   perf/run.sh checkpoint     what a checkpoint costs, beside the disk's own speed
#   perf/run.sh long_run       memory and rate as time goes
#   perf/run.sh accuracy       what accuracy costs in time, Table 5 and 20,000 granules
#   perf/run.sh sweep          eight cases, one and two at a time
#   perf/run.sh all            all of these
# REPEATS=N: runs in turn (3); QUICK=1: everything small, to see that it works; GRANDAMP_PERF_BUILD: the build folder.
set -euo pipefail
cd "$(dirname "$0")/.."
source io/packages.sh
names=(kernels scenes peers sizes radii threads paper_table4 paper_fig14 effects checkpoint long_run accuracy sweep)
wanted=("$@")
[ "${1-}" = all ] && wanted=("${names[@]}")
for name in "${wanted[@]:-none}"; do
  [[ " ${names[*]} " == *" $name "* ]] || { [ $# -eq 0 ] || echo "perf/run.sh: '$name' is no measurement" >&2; sed -n '2,17p' "$0" | cut -c3-; exit 2; }
done

[[ ${REPEATS-3} =~ ^[1-9][0-9]*$ ]] || { echo "perf/run.sh: REPEATS='$REPEATS': a whole number above 0" >&2; exit 2; }

perf_packages=("${build_packages[@]}" binutils lammps libbenchmark-dev liggghts python3 python3-matplotlib python3-numpy
  valgrind)
install_packages "${perf_packages[@]}"
export GRANDAMP_PERF_BUILD=${GRANDAMP_PERF_BUILD:-$PWD/build-perf}
cmake -S . -B "$GRANDAMP_PERF_BUILD" -G Ninja -DCMAKE_BUILD_TYPE=Release -DGRANDAMP_BENCHES=ON -DGRANDAMP_TESTS=OFF >/dev/null
cmake --build "$GRANDAMP_PERF_BUILD" -j "${JOBS:-$(nproc)}" >&2
for name in "${wanted[@]}"; do
  (cd perf && "${python:-/usr/bin/python3}" -B -m measure "$name")
done
