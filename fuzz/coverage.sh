#!/usr/bin/env bash
# What the corpora of the fuzz targets reach in the code under test, as HTML and as a list of the lines they do not.
#
#   fuzz/coverage.sh [FOLDER]     build/coverage/report if no folder is given
#
# Leaves FOLDER/index.html and FOLDER/unreached.txt ("file:line: text", and behind it the reason of fuzz/unreached_reasons.txt), and
# prints the share of lines reached. Exit code 1 when a line of protocol/, of the FX emulator or of a parser is neither
# reached nor has a reason.
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
         if (text ~ /[^ \t{}]/) print file ":" part[1] ": " text }' |
  awk -F: '
    NR == FNR { if (/^= /) reason = substr($0, 3)
                else if (/^[^#]/) { file = $0; sub(/ .*/, "", file); text = $0; sub(/^[^ ]+ +/, "", text)
                  count[file]++; texts[file, count[file]] = text; reasons[file, count[file]] = reason }
                next }
    { why = ""; line = $0; sub(/^[^:]*:[0-9]*: */, "", line); sub(/ +$/, "", line)
      for (i = 1; i <= count[$1] && why == ""; ++i)
        if (texts[$1, i] == "*" || texts[$1, i] == line) why = "   <- " reasons[$1, i]
      print $0 why }' fuzz/unreached_reasons.txt - >"$report/unreached.txt"

# share NAME PATH...
share() {
  local name=$1
  shift
  cov report "$@" | awk -v name="$name" '$1 == "TOTAL" { printf "  %-24s %s of %s lines reached\n", name, $10, $8 }'
}
emulator=(emulator_models/{fx_plc_emulator,fx_plc,device_memory,special_devices,fx_address_map}.cpp)
parsers=(kernel_mocks/{nc_parser,nc_lexer}.cpp emulator_models/soft_plc/{il_parser,il_lexer,il_literal}.cpp)
say "lines reached by the corpora"
share "protocol" protocol
share "FX emulator" "${emulator[@]}"
share "parsers" "${parsers[@]}"
unexplained=$(grep -E "^($(tr ' ' '|' <<<"protocol/ ${emulator[*]} ${parsers[*]}"))" "$report/unreached.txt" | grep -v "   <- ")
[ -z "$unexplained" ] || { printf '%s\n' "$unexplained" >&2; die "these lines are not reached, and fuzz/unreached_reasons.txt does not say why" 1; }
say "$(wc -l <"$report/unreached.txt") lines that no corpus reaches are in $report/unreached.txt; open $report/index.html"
