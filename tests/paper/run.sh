#!/usr/bin/env bash
# Builds the release and reruns the paper: figures, tables and bounds into tests/paper/RESULTS.md, pictures beside it.
#   tests/paper/run.sh              everything, some twenty minutes on two cores
#   tests/paper/run.sh NAME...      fig2 fig6 fig7 fig8 fig11 fig12 fig14 table5 fig15 fig16 fig17 size490 work fig18 table6
# Exit status 1 if a bound is missed, and which. Runs are kept in build/paper/runs and used again by the same program.
# GRANDAMP_PAPER_RESULTS: another folder for RESULTS.md; JOBS: runs at a time.
set -euo pipefail
cd "$(dirname "$0")/../.."
source io/packages.sh
install_packages "${paper_packages[@]}"
cmake --preset release -DGRANDAMP_TESTS=ON >/dev/null
cmake --build --preset release --target grandamp_program reference_program -j "$(nproc)" >&2
cd tests/paper
exec "$python" -B -m figures "$@"
