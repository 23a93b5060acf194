#!/usr/bin/env bash
# Runs the hard cases and writes tests/hard_cases/RESULTS.md from what they print.
#   bash tests/hard_cases/run.sh           as long and as large as they are meant: twenty minutes on two processors
#   bash tests/hard_cases/run.sh --short   the form of every day
# The release build with its tests must be there: cmake --preset release -DGRANDAMP_TESTS=ON && cmake --build --preset release
set -uo pipefail
cd "$(dirname "$0")/../.." || exit 1

form=full
case "${1-}" in
  "") export GRANDAMP_FULL=1 ;;
  --short) form=short; unset GRANDAMP_FULL ;;
  *) sed -n '2,5p' "$0" | cut -c3- >&2; exit 2 ;;
esac
program=build/tests/test_hard_cases
[ -x $program ] || { echo "$program is not built" >&2; exit 1; }

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
start=$SECONDS
# Each case by itself, as many at a time as there are processors.
cases=$($program --count --no-version | sed -n 's/.*test cases.*: *\([0-9]*\)$/\1/p')
seq "${cases:?}" | xargs -P "${JOBS:-$(nproc)}" -I{} sh -c \
  "$program --no-colors --duration=false --first={} --last={} >$folder/{}; echo \$? >$folder/{}.status"
printed=$folder/all
for ((k = 1; k <= cases; k++)); do cat "$folder/$k"; done >"$printed"
grep -E '^(\| \*\*|ERROR)' "$printed"
failed=0
for ((k = 1; k <= cases; k++)); do [ "$(cat "$folder/$k.status")" = 0 ] || failed=$((failed + 1)); done
took=$((SECONDS - start))
verdict="$cases, $failed failed"
echo "test cases: $verdict"

header='| case | choice | granules | steps | not finite | nearest wall, radii | energy rise / allowed, % | residual, % | momentum | angular momentum | missed / audits | deepest overlap, % | closing met / assumed, m/s | note |
| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |'
{
  cat <<END
# Hard cases: what they showed

Written by \`bash tests/hard_cases/run.sh$([ $form = short ] && echo ' --short')\` in $took s: the $form form. Test cases: $verdict.

Every case runs under a table of choices in which each pair of settings stands in some row: friction, precision, list policy, steps
per contact, integrator, seed (\`choices.cpp\`). A figure is the worst of the whole run; in the first table the worst of all runs whose
lists missed nothing. *Energy rise*: of the stored energy less the work put in, over the largest kinetic and elastic energy, beside
what the integrator does to one elastic contact at that step. *Residual*: of the ledger, over its largest term. *Momentum*: change
that no impulse of gravity or walls explains. *Angular momentum*: about the centre of mass, in stretches without wall contacts.
*Missed*: contacts that an all-pairs search found and the list did not have.

## Case by case

$header
END
  grep '^| \*\*' "$printed"
  echo
  echo '## Remarks'
  echo
  grep '^> ' "$printed" | grep -v ': missed: ' | sed 's/^> /- /'
  echo
  echo '## Contacts missed'
  echo
  echo "Only policies that may miss did: the paper's (\`predicted\`) and \`fixed\`."
  echo
  grep '^> .*: missed: ' "$printed" | sed 's/^> /- /; s/: missed: /: /'
  echo
  echo '## Every run'
  echo
  echo "$header"
  grep '^| ' "$printed" | grep -v '^| \*\*'
} >tests/hard_cases/RESULTS.md
[ "$failed" -eq 0 ]
