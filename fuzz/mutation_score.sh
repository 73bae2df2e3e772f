#!/usr/bin/env bash
# How many of the planted faults (fuzz/planted_faults.txt) the fuzz targets, property tests and scenarios find, each by whom and
# after how many executions. Takes half an hour or more, most of it compiling.
#
#   fuzz/mutation_score.sh [NAME...]     all faults if none is named; "none" is the code as it is
#   fuzz/mutation_score.sh --list-only   only looks whether each fault's line stands once in its file
#
#   SECONDS_EACH   real time for one target and fault, 20 if not set
#   RUNS_EACH      and at most so many executions, 200000 if not set
#
# Works on a copy of the sources in build/planted, one fault at a time; the code as it is comes first, and nobody may find
# anything in it. Only the programs that a fault is linked into are run. Writes build/planted/score.txt. Exit code: 0 when
# at least 24 of 25 are found and nothing in the code as it is, 1 otherwise.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 3
. .ci/setup.sh
. fuzz/engine_options.sh

list=$PWD/fuzz/planted_faults.txt
planted=$PWD/build/planted
copy=$planted/source
score=$planted/score.txt
seconds=${SECONDS_EACH:-20}
runs=${RUNS_EACH:-200000}
# Silent in the code as it is.
scenarios=(paper/one-request paper/three-requests nc/part-program)

# field NAME file|old|new: of a fault.
field() {
  awk -v name="$1" -v what="$2" '
    $0 !~ /^[-+#]/ && NF == 2 { current = $1; file = $2 }
    current == name && what == "file" && $1 == name { print file; exit }
    current == name && what == "old" && /^- / { print substr($0, 3); exit }
    current == name && what == "new" && /^\+ / { print substr($0, 3); exit }' "$list"
}

all_names() { awk '$0 !~ /^[-+#]/ && NF == 2 { print $1 }' "$list"; }

# plant NAME: into the copy.
plant() {
  local file
  file=$copy/$(field "$1" file)
  old=$(field "$1" old) new=$(field "$1" new) awk '
    { text = $0; sub(/^ +/, "", text) }
    text == ENVIRON["old"] { match($0, /^ */); $0 = substr($0, 1, RLENGTH) ENVIRON["new"] }
    { print }' "$file" >"$file.planted" && mv "$file.planted" "$file"
}

# restore NAME: the line as it is.
restore() { cp "$(field "$1" file)" "$copy/$(field "$1" file)"; }

check_list() {
  local name file count wrong=0
  for name in $(all_names); do
    file=$(field "$name" file)
    count=$(sed 's/^ *//' "$file" | grep -cxF -- "$(field "$name" old)")
    [ "$count" -eq 1 ] || { echo "fuzz/planted_faults.txt: $name: its line stands $count times in $file, expected once"; wrong=1; }
  done
  return $wrong
}

# build_copy: what finds faults, in the copy. Programs that did not change keep their time.
build_copy() {
  local log=$planted/build.log
  (cd "$copy" &&
    cmake --preset fuzz && cmake --build --preset fuzz --target fuzz_targets &&
    cmake --preset fuzz-world && cmake --build --preset fuzz-world --target fuzz_world_targets &&
    cmake --preset release && cmake --build --preset release --target property_tests ltsim) >"$log" 2>&1
}

# relinked FILE: whether it was linked after the fault was planted.
relinked() { [ "$1" -nt "$planted/before" ]; }

# found WHO EXECUTIONS
found() { findings+=("$1 ($2)"); }

run_engine() {
  local program=$1 name=${1##*/fuzz-} options log=$planted/run.log
  engine_options "$name"
  rm -rf "$planted/corpus" && mkdir -p "$planted/corpus"
  "$program" "$planted/corpus" "fuzz/corpus/$name" "${options[@]}" -seed=1 -runs="$runs" -max_total_time="$seconds" -timeout=10 \
    -artifact_prefix="$planted/" -print_final_stats=1 >"$log" 2>&1 && return
  found "fuzz-$name" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")"
}

run_properties() {
  local program=$1 log=$planted/run.log
  "$program" >"$log" 2>&1 && return
  found "${program##*/}" "$(sed -n 's/^Falsifiable after \([0-9]*\).*/\1/p' "$log" | head -n 1)"
}

run_scenarios() {
  local scenario executions
  for scenario in "${scenarios[@]}"; do
    "$copy/build/release/bin/ltsim" explore "$scenario" --executions 2000 --seconds "$seconds" --minimize-seconds 0 \
      --out "$planted/out" --json "$planted/run.json" >"$planted/run.log" 2>&1 && continue
    executions=$(sed -n 's/.*"executions": *\([0-9]*\).*/\1/p' "$planted/run.json" | head -n 1)
    found "$scenario" "$executions"
  done
}

# look_for NAME: builds, runs all that may find it, and tells who did.
look_for() {
  local program
  findings=()
  if ! build_copy; then
    tail -n 20 "$planted/build.log" >&2
    printf '%-34s %s\n' "$1" "does not build" | tee -a "$score"
    return 1
  fi
  for program in "$copy"/build/fuzz/bin/fuzz-* "$copy"/build/fuzz-world/bin/fuzz-*; do
    ! relinked "$program" || run_engine "$program"
  done
  for program in "$copy"/build/release/bin/*_properties; do ! relinked "$program" || run_properties "$program"; done
  ! relinked "$copy/build/release/bin/ltsim" || run_scenarios
  local told="-"
  [ ${#findings[@]} -eq 0 ] || told=$(printf '%s, ' "${findings[@]}")
  printf '%-34s %s\n' "$1" "${told%, }" | tee -a "$score"
  [ ${#findings[@]} -gt 0 ]
}

check_list || exit 2
[ "${1:-}" != --list-only ] || exit 0
names=("$@")
[ $# -gt 0 ] || mapfile -t names < <(echo none; all_names)

install_missing .ci/packages.txt .ci/packages-ci.txt
mkdir -p "$copy"
git ls-files -co --exclude-standard | while read -r file; do
  cmp -s "$file" "$copy/$file" || { mkdir -p "$copy/$(dirname "$file")" && cp "$file" "$copy/$file"; }
done
: >"$score"
say "fault, and who finds it (after how many executions)"
wrong=0 missed=0 planted_count=0
for name in "${names[@]}"; do
  if [ "$name" = none ]; then
    touch -d @0 "$planted/before"
    ! look_for none || wrong=1
    continue
  fi
  [ -n "$(field "$name" file)" ] || die "no fault is called \"$name\"; fuzz/planted_faults.txt has them" 2
  planted_count=$((planted_count + 1))
  build_copy || { tail -n 20 "$planted/build.log" >&2; die "the code as it is does not build" 3; }
  touch "$planted/before"
  plant "$name"
  look_for "$name" || missed=$((missed + 1))
  restore "$name"
done
say "$((planted_count - missed)) of $planted_count found; the table is in $score"
[ "$wrong" -eq 0 ] || die "something was found in the code as it is" 1
[ $((missed * 25)) -le "$planted_count" ] || exit 1
