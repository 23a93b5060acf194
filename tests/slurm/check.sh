#!/usr/bin/env bash
# check.sh PROGRAM: io/slurm/sweep.sbatch as a job array on a Slurm of one node, whose services are started here, in a
# temporary folder, and stopped again. Needs to be root: slurmd starts jobs for users.
set -euo pipefail
program=$(realpath "$1")
source_folder=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(mktemp -d /tmp/grandamp-slurm-XXXXXX)
chmod 755 "$folder"
node=$(hostname -s)
processes=()

stop() {
  local status=$? process
  for process in ${processes[@]+"${processes[@]}"}; do kill "$process" 2>/dev/null || true; done
  for process in ${processes[@]+"${processes[@]}"}; do wait "$process" 2>/dev/null || true; done
  if [ $status -ne 0 ]; then tail -n 20 "$folder"/*.log "$folder"/jobs/*.log 2>/dev/null || true; fi
  rm -rf "$folder"
  exit $status
}
trap stop EXIT

# until WHAT SECONDS COMMAND...: waits for a command to succeed.
until_true() {
  local what=$1 seconds=$2 i
  shift 2
  for ((i = 0; i < seconds * 5; ++i)); do
    if "$@" >/dev/null 2>&1; then return 0; fi
    sleep 0.2
  done
  echo "waited $seconds s in vain: $what" >&2
  return 1
}

mkdir "$folder/state" "$folder/spool" "$folder/jobs" "$folder/munge"
chmod 755 "$folder/munge"
head -c 1024 /dev/urandom >"$folder/munge/key"
chmod 400 "$folder/munge/key"
munged --force --foreground --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
  --pid-file="$folder/munge/pid" --seed-file="$folder/munge/seed" --log-file="$folder/munge.log" &
processes+=($!)
until_true "munged" 30 munge --socket="$folder/munge/socket" --no-input

port=$((20000 + RANDOM % 20000))
cat >"$folder/slurm.conf" <<END
ClusterName=grandamp
SlurmctldHost=$node(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
CredType=cred/munge
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
ReturnToService=2
MailProg=/bin/true
NodeName=$node NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$node Default=YES MaxTime=INFINITE State=UP
END
export SLURM_CONF=$folder/slurm.conf
slurmctld -D -i >"$folder/slurmctld.log" 2>&1 &
processes+=($!)
slurmd -D -N "$node" >"$folder/slurmd.log" 2>&1 &
processes+=($!)
until_true "an idle node" 60 sh -c 'sinfo --noheader --format=%t | grep -qx idle'

cd "$folder/jobs"
cp "$source_folder/tests/slurm/scene.toml" .
export GRANDAMP=$program
sbatch --array=0-2 "$source_folder/io/slurm/sweep.sbatch" scene.toml --vary structure.damping=0.05:0.1:4 --seeds 2 -o sweep
until_true "the end of the array" 300 sh -c '[ -z "$(squeue --noheader)" ]'

# The same in one go, without Slurm: every number but the times is the same.
"$program" sweep scene.toml --vary structure.damping=0.05:0.1:4 --seeds 2 -o whole --quiet
/usr/bin/python3 - <<'END'
import csv, json
array, whole = (json.load(open(f"{folder}/sweep.json")) for folder in ("sweep", "whole"))
assert array["status"] == "done", array["status"]
assert array["runs"] == {"planned": 8, "done": 8, "failed": 0}, array["runs"]
for one, other in zip(array["points"], whole["points"]):
    assert one["values"] == other["values"]
    for name in array["numbers"]:
        if name != "wall_time":
            assert one["mean"][name] == other["mean"][name], name
assert len(list(csv.DictReader(open("sweep/sweep.csv")))) == 4
END
parts=$(grep -l "part [0-2] of 3" grandamp-sweep-*.log | wc -l)
[ "$parts" -eq 3 ]
echo "a job array of 3 tasks made one sweep of 8 runs"
