# The project's Debian 12 packages: the one list. Sourced by io/demo.sh and tests/run.sh.
# shellcheck shell=bash disable=SC2034

# libjs-*: embedded in the pages of `grandamp report`.
build_packages=(g++ cmake ninja-build libcli11-dev libeigen3-dev libfmt-dev libhdf5-dev libjs-chart.js libjs-dygraphs
  libjs-three libnlopt-cxx-dev libnlopt-dev libspdlog-dev libtbb-dev libtomlplusplus-dev libxsimd-dev libxxhash-dev
  nlohmann-json3-dev)

demo_packages=("${build_packages[@]}" python3 python3-matplotlib python3-numpy)

# clang-14: libFuzzer and clang-tidy; qemu-user: the program on a processor without AVX; h5py and matplotlib: another reader of
# our files, and the paper's figures; chromium, which needs a font, and python3-websocket, which speaks to it: reports' pages.
test_packages=("${build_packages[@]}" binutils chromium clang-14 clang-format-14 clang-tidy-14 doctest-dev fonts-dejavu-core git
  libbenchmark-dev hdf5-tools libclang-rt-14-dev python3 python3-h5py python3-matplotlib python3-numpy python3-websocket
  qemu-user)

paper_packages=("${build_packages[@]}" doctest-dev python3 python3-h5py python3-matplotlib python3-numpy)

# Large: what ParaView makes of snapshots, and LIGGGHTS beside us; without them those tests are skipped. Slurm: a sweep as a
# job array.
full_test_packages=("${test_packages[@]}" liggghts munge paraview python3-paraview slurm-client slurmctld slurmd)

# The interpreter that the python3-* packages are for; another may come first in PATH.
python=/usr/bin/python3

# install_packages NAME...: what is missing, and nothing (no network either) if nothing is.
install_packages() {
  local missing=() package
  for package in "$@"; do
    [ "$(dpkg-query -W -f='${db:Status-Abbrev}' "$package" 2>/dev/null)" = "ii " ] || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return 0
  echo "Installing: ${missing[*]}"
  local as_root=()
  [ "$(id -u)" -eq 0 ] || as_root=(sudo)
  "${as_root[@]}" apt-get update -qq &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}
