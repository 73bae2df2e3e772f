#!/usr/bin/env bash
# Whether minimal schedules outlive a rebuild: those of the release build must fail in the same way in programs
# built with other optimisation flags and by the other compiler.
#
#     tests/scenarios/rebuild_check.sh [FOLDER [PRESET...]]
#
# FOLDER   holds schedules, at any depth; where it holds none they are made: of each scenario that fails, from
#          seeds 1 and 2, with the release build. Default: build/rebuild-schedules, made anew.
# PRESET   of CMakePresets.json. Default: debug (gcc, -O0) and clang; release itself is gcc, -O3.
#
# Exit code: 0 when at least 95 of 100 schedules fail as recorded in each preset, 1 when fewer do, 2 when there
# are no schedules, 3 when a build fails.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit 3

folder=${1:-build/rebuild-schedules}
[ $# -gt 0 ] || rm -rf "$folder"
[ $# -eq 0 ] || shift
presets=("$@")
[ ${#presets[@]} -gt 0 ] || presets=(debug clang)
jobs=${LTSIM_BUILD_JOBS:-2}

build() {
  { [ -e "build/$1/build.ninja" ] || cmake --preset "$1"; } >"build/$1-rebuild.log" 2>&1 &&
    cmake --build --preset "$1" --target ltsim -j "$jobs" >>"build/$1-rebuild.log" 2>&1 && return
  tail -20 "build/$1-rebuild.log" >&2
  exit 3
}

make_schedules() {
  local scenario seed
  build release
  for scenario in $(build/release/bin/ltsim list | awk '{ print $1 }' | grep -v -e '-corrected$'); do
    for seed in 1 2; do
      build/release/bin/ltsim explore "$scenario" --seed "$seed" --executions 5000 --seconds 5 --minimize-seconds 1 \
        --out "$folder/seed-$seed" >/dev/null || continue  # 1: a failure was found
    done
  done
}

schedules() { find "$folder" -name '*.schedule' 2>/dev/null | sort; }

mkdir -p build
[ -n "$(schedules)" ] || make_schedules
total=$(schedules | wc -l)
[ "$total" -gt 0 ] || { echo "$folder: no schedules" >&2; exit 2; }

code=0
for preset in "${presets[@]}"; do
  build "$preset"
  failed=0
  while read -r schedule; do
    output=$("build/$preset/bin/ltsim" replay "$schedule" 2>&1)
    if [ $? -eq 1 ] && ! grep -q 'not as recorded' <<<"$output"; then
      failed=$((failed + 1))
    else
      printf '%s  %s\n' "$preset" "$schedule"
      grep -e 'no longer fits' -e 'not as recorded' -A1 <<<"$output" | sed 's/^/    /'
    fi
  done < <(schedules)
  echo "$preset: $failed of $total schedules fail as recorded"
  [ $((100 * failed)) -ge $((95 * total)) ] || code=1
done
exit $code
