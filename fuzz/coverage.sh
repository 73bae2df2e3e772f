#!/usr/bin/env bash
# What the corpora of the fuzz targets reach in the code under test, as HTML and as a list of the lines they do not.
#
#   fuzz/coverage.sh [FOLDER]     build/coverage/report if no folder is given
#
# Leaves FOLDER/index.html and FOLDER/unreached.txt ("file:line: text"), and prints the share of lines reached.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit 3
. .ci/setup.sh
report=${1:-build/coverage/report}

install_missing .ci/packages.txt .ci/packages-ci.txt .ci/packages-fuzz.txt
build coverage

say "running every target over its corpus"
profiles=$(mktemp -d)
trap 'rm -rf "$profiles"' EXIT
programs=()
for program in build/coverage/bin/fuzz-*; do
  name=${program##*/fuzz-}
  inputs=("fuzz/corpus/$name")
  [ ! -d "fuzz/regressions/$name" ] || inputs+=("fuzz/regressions/$name")
  LLVM_PROFILE_FILE="$profiles/$name.profraw" "$program" "${inputs[@]}" || die "fuzz-$name fails over its corpus" 1
  programs+=(-object "$program")
done
llvm-profdata-19 merge -sparse "$profiles"/*.profraw -o "$profiles/all.profdata" || die "llvm-profdata failed" 3
programs=("${programs[@]:1}")

# cov COMMAND [ARGUMENTS]: llvm-cov over all programs.
cov() {
  local command=$1
  shift
  llvm-cov-19 "$command" "${programs[@]}" -instr-profile="$profiles/all.profdata" "$@"
}

mkdir -p "$report"
cov show -format=html -output-dir="$report" -ignore-filename-regex='^/usr/|/build/' >/dev/null ||
  die "llvm-cov failed" 3
cov show -ignore-filename-regex='^/usr/|/build/' protocol emulator_models kernel_mocks |
  awk '/^\/.*:$/ { file = $0; sub(":$", "", file); sub("^" ENVIRON["PWD"] "/", "", file); next }
       match($0, /^ *[0-9]+\| +0\|/) { split($0, part, "|"); gsub(/ /, "", part[1]); text = substr($0, RLENGTH + 1)
         if (text ~ /[^ \t{}]/) print file ":" part[1] ": " text }' >"$report/unreached.txt"

# share NAME PATH...
share() {
  local name=$1
  shift
  cov report "$@" | awk -v name="$name" '$1 == "TOTAL" { printf "  %-24s %s of %s lines reached\n", name, $10, $8 }'
}
say "lines reached by the corpora"
share "protocol" protocol
share "FX emulator" emulator_models/fx_plc_emulator.cpp emulator_models/fx_plc.cpp emulator_models/device_memory.cpp emulator_models/special_devices.cpp
share "parsers" kernel_mocks/nc_parser.cpp kernel_mocks/nc_lexer.cpp emulator_models/soft_plc/il_parser.cpp emulator_models/soft_plc/il_lexer.cpp
say "$(wc -l <"$report/unreached.txt") lines that no corpus reaches are in $report/unreached.txt; open $report/index.html"
