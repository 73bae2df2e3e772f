#!/usr/bin/env bash
# How often a second of processor time the fuzz targets run, and what share of the rate of an empty target that is: all are run in
# turn, ROUNDS times, and the fastest round of each counts.
#
#   tests/bench/fuzz_rates.sh [TARGET...]     all if none is named
#
#   ROUNDS         3 if not set
#   SECONDS_EACH   real time for one target in a round, 5 if not set
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 3
. .ci/setup.sh
. fuzz/engine_options.sh

rounds=${ROUNDS:-3}
seconds=${SECONDS_EACH:-5}
install_missing .ci/packages.txt .ci/packages-ci.txt
for preset in fuzz fuzz-world; do
  cmake --preset "$preset" >/dev/null && cmake --build --preset "$preset" --target fuzz_targets fuzz-nothing >build/fuzz.log 2>&1 ||
    { tail -n 60 build/fuzz.log >&2; die "building failed; the whole output is in build/fuzz.log" 3; }
done
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# rate PROGRAM: executions in a second of processor time.
rate() {
  local name=${1##*/fuzz-} options corpora=("$scratch/corpus")
  [ ! -d "fuzz/corpus/$name" ] || corpora+=("fuzz/corpus/$name")
  engine_options "$name"
  rm -rf "$scratch/corpus" && mkdir -p "$scratch/corpus"
  local TIMEFORMAT='%U %S'
  { time "$1" "${corpora[@]}" "${options[@]}" -max_total_time="$seconds" -print_final_stats=1 \
    -artifact_prefix="$scratch/" >"$scratch/log" 2>&1; } 2>"$scratch/time"
  awk '/^stat::number_of_executed_units/ { runs = $2 } FILENAME ~ /time$/ { seconds = $1 + $2 }
       END { printf "%d\n", runs / seconds }' "$scratch/log" "$scratch/time"
}

programs=()
for program in build/fuzz/bin/fuzz-* build/fuzz-world/bin/fuzz-*; do
  name=${program##*/fuzz-}
  [ $# -eq 0 ] || [ "$name" = nothing ] || [[ " $* " == *" $name "* ]] || continue
  programs+=("$program")
done
declare -A best
for ((round = 0; round < rounds; ++round)); do
  for program in "${programs[@]}"; do
    now=$(rate "$program")
    [ "$now" -le "${best[$program]:-0}" ] || best[$program]=$now
  done
done
printf '%-36s %12s %10s\n' "" "a second" "of empty"
for program in "${programs[@]}"; do
  awk -v program="${program#build/}" -v rate="${best[$program]}" -v empty="${best[${program%/*}/fuzz-nothing]}" \
    'BEGIN { sub("/bin/", " ", program); printf "%-36s %12d %9.1f %%\n", program, rate, 100 * rate / empty }'
done
