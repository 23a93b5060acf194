#!/usr/bin/env bash
# Pages of `grandamp report` in a headless Chromium: check.sh BUILD [FOLDER]; screenshots are left in FOLDER.
set -euo pipefail
cd "$(dirname "$0")/../.."
source io/packages.sh
program=$PWD/$1/grandamp
pictures=${2-}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$program" run tests/report/shaken_box.toml -o "$work/box" --threads 1 --quiet --profile
# The same as one that does not let itself be believed, its title made to be run as code.
"$program" run tests/report/shaken_box.toml -o "$work/evil" --threads 1 --quiet --set granules.0.count=40 --set granules.1.count=10 \
  --set 'title="</title><script>document.documentElement.dataset.evil=1</script>"' --set output.snapshot_interval=0 --set time.duration=0.05
rm "$work/evil/summary.json"
"$program" study accuracy tests/report/shaken_box.toml -o "$work/study" --quiet --seeds 2 --vary steps --set time.duration=0.02 \
  --set granules.0.count=30 --set granules.1.count=10 --set output.window=[0.01,0.02]
for folder in box evil study; do "$program" report "$work/$folder" --quiet; done
du -h "$work"/*/report.html
"$python" tests/report/pages.py "$work" ${pictures:+"$pictures"}
