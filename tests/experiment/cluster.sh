#!/bin/bash
# cluster.sh GRRL-EXPERIMENT EXPERIMENT.SBATCH CASE: parts of a run, merged, are the run. Cases: shards
# (one after the other), parallel (GNU parallel), slurm (a cluster of this machine, made for the test).
# Exit status 77: skipped.
set -u
BIN=$1 SBATCH=$2 CASE=$3
export LC_ALL=C

skip() {
    echo "skipped: $*"
    exit 77
}

# needs PACKAGE PROGRAM..
needs() {
    local package=$1 program
    shift
    for program in "$@"; do
        [ -n "$(PATH=$PATH:/usr/sbin command -v "$program")" ] || skip "no $program (Debian: $package)"
    done
}

case $CASE in
parallel) needs parallel parallel ;;
slurm)
    needs munge munged
    needs slurmctld slurmctld
    needs slurmd slurmd
    needs slurm-client sbatch sinfo
    ;;
esac

WORK=$(mktemp -d)
PIDS=()
stop() {
    local pid
    for pid in "${PIDS[@]}"; do
        kill "$pid" 2>/dev/null
    done
    wait
    rm -rf "$WORK"
}
trap stop EXIT
cd "$WORK" || exit 1

fail() {
    echo "FAILED: $*"
    cat output.txt
    exit 1
}

# A cluster of one node with two cores, all of whose files are in this folder.
start_slurm() {
    export SLURM_CONF=$WORK/slurm.conf
    local user host port
    user=$(id -un) host=$(hostname -s) port=$((20000 + $$ % 20000))
    chmod 755 "$WORK"
    mkdir -m 755 state spool munge
    head -c 64 /dev/urandom >munge/key
    chmod 600 munge/key
    cat >slurm.conf <<END
ClusterName=one
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$port
SlurmdPort=$((port + 1))
SlurmUser=$user
SlurmdUser=$user
AuthType=auth/munge
AuthInfo=socket=$WORK/munge/socket
CredType=cred/munge
StateSaveLocation=$WORK/state
SlurmdSpoolDir=$WORK/spool
SlurmctldPidFile=$WORK/slurmctld.pid
SlurmdPidFile=$WORK/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES State=UP
END
    PATH=$PATH:/usr/sbin
    munged --foreground --force --key-file="$WORK/munge/key" --socket="$WORK/munge/socket" \
        --pid-file="$WORK/munge/pid" --log-file="$WORK/munge/log" --seed-file="$WORK/munge/seed" \
        >munged.txt 2>&1 &
    PIDS+=($!)
    slurmctld -D -i >slurmctld.txt 2>&1 &
    PIDS+=($!)
    slurmd -D >slurmd.txt 2>&1 &
    PIDS+=($!)
    for ((i = 0; i < 60; i++)); do
        sinfo -h -o %T 2>/dev/null | grep -qx idle && return
        sleep 0.5
    done
    cat munged.txt slurmctld.txt slurmd.txt
    skip "Slurm cannot run here"
}

options=(--object RR --object PR --policy "random,learn,rule-pas" --pretrain R:2 --trials 3
    --experiments 3 --seed 2..3)
"$BIN" --out whole "${options[@]}" >output.txt 2>&1 || fail "the whole run ended with $?"
case $CASE in
shards)
    for i in 1 2 3; do
        "$BIN" --out part-$i "${options[@]}" --shard $i/3 >output.txt 2>&1 || fail "part $i"
        [ ! -e part-$i/trials.csv ] || fail "part $i has a table"
    done
    ;;
parallel)
    # shellcheck disable=SC1083
    parallel --will-cite --jobs 2 "$BIN" --out part-{} "${options[@]@Q}" --jobs 1 --shard {}/4 ::: 1 2 3 4 \
        >output.txt 2>&1 || fail "parallel ended with $?"
    ;;
slurm)
    start_slurm
    GRRL_EXPERIMENT=$BIN sbatch --wait --array=1-4 --output=slurm-%a.txt "$SBATCH" "$WORK" \
        "${options[@]}" >output.txt 2>&1 || fail "sbatch ended with $?: $(cat slurm-*.txt)"
    sinfo --version
    ;;
*)
    fail "no such case"
    ;;
esac
"$BIN" merge --out all part-* >output.txt 2>&1 || fail "merge ended with $?"
for table in trials.csv summary.csv; do
    cmp whole/$table all/$table || fail "$table differs"
done

# refused MESSAGE ARGUMENT..: exit status 1
refused() {
    local message=$1 status=0
    shift
    "$BIN" merge "$@" >output.txt 2>&1 || status=$?
    [ "$status" -eq 1 ] || fail "merge $* ended with $status"
    grep -q -e "$message" output.txt || fail "merge $*: no '$message'"
}
refused 'experiments are missing in these parts, such as RR random' --out few part-1 part-3
"$BIN" --out part-x --object RR --trials 4 --experiments 1 --shard 1/2 >/dev/null 2>&1
refused "part-x holds another run: '4' there, '3' in the first" --out x part-1 part-x
refused 'part-none is no folder of results' --out y part-1 part-none
