#!/usr/bin/env bash
# The house's order: kernels <- solver <- io, nothing includes upwards; xsimd and intrinsics live in kernels/ alone;
# the top level holds what it should. Prints what breaks a rule; exit status 1 if anything does.
set -uo pipefail
cd "$(dirname "$0")/../.."
status=0

# forbid WHAT PATTERN FOLDER...: no source file in the folders may have an include that matches.
forbid() {
  local what=$1 pattern=$2 found
  shift 2
  found=$(grep -rnE --include='*.[ch]pp' --include='*.h' "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($pattern)" "$@")
  if [ -n "$found" ]; then
    printf '%s:\n%s\n' "$what" "$found"
    status=1
  fi
}
forbid "kernels/ includes upwards" '(solver|io|tests|perf)/' kernels
forbid "solver/ includes upwards" '(io|tests|perf)/' solver
forbid "io/ includes upwards" '(tests|perf)/' io
forbid "a path relative to the file; say \"solver/x.hpp\"" '\.' kernels solver io tests perf
forbid "xsimd or intrinsics outside kernels/" 'xsimd/|[a-z]*intrin\.h|arm_neon\.h' solver io
forbid "libraries that kernels/ must not know" '(tbb|oneapi|Eigen|toml|CLI|hdf5|spdlog|fmt|nlohmann)[/+.]|(thread|fstream|iostream)>' kernels
forbid "libraries of io/ in solver/" '(toml|CLI|spdlog|nlohmann)[/+.]|hdf5\.h' solver

for folder in kernels solver io; do
  if [ -z "$(find $folder -name '*.cpp' -print -quit)" ]; then
    echo "$folder/ has no sources: nothing was checked"
    status=1
  fi
done

if git rev-parse --git-dir >/dev/null 2>&1; then top=$(git ls-files | cut -d/ -f1 | sort -u); else top=$(ls -A); fi
strays=$(grep -vxE '\..*|CMakeLists\.txt|CMakePresets\.json|LICENSE|README\.md|kernels|solver|io|tests|perf|build|build-.*|demo-output' <<<"$top")
if [ -n "$strays" ]; then
  printf 'strays at the top level:\n%s\n' "$strays"
  status=1
fi
exit $status
