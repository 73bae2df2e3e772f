#!/usr/bin/env bash
# Builds the fuzz targets for a fuzzing service, by the contract of OSS-Fuzz and its kind.
#
#   CC, CXX, CFLAGS, CXXFLAGS   the service's compiler, with its instrumentation
#   LIB_FUZZING_ENGINE          what a target is linked with in place of a main()
#   SANITIZER                   address (the default), undefined, or none: targets in the simulated world are built for `none`
#                               only, since it and a sanitizer's runtime claim the same instrumentation
#   OUT                         gets fuzz-NAME, fuzz-NAME.dict, fuzz-NAME.options, fuzz-NAME_seed_corpus.zip
#   WORK                        folder to build in; build/service if not given
#
# With nothing but OUT it takes clang 19 and libFuzzer. AFL++ (Debian: afl++) finds its targets so:
#   CXX=clang++-19 CC=clang-19 CXXFLAGS=-fsanitize-coverage=trace-pc-guard SANITIZER=none OUT=... \
#   LIB_FUZZING_ENGINE="/usr/lib/afl/libAFLDriver.a /usr/lib/afl/afl-compiler-rt.o" fuzz/build.sh
set -eu
cd "$(dirname "${BASH_SOURCE[0]}")/.."

: "${OUT:?names the folder for what is built}"
: "${CC:=clang-19}" "${CXX:=clang++-19}" "${SANITIZER:=address}" "${WORK:=build/service}"
if [ -z "${LIB_FUZZING_ENGINE:-}" ]; then
  LIB_FUZZING_ENGINE=-fsanitize=fuzzer
  CXXFLAGS="${CXXFLAGS:-} -fsanitize=fuzzer-no-link"
fi
case $SANITIZER in
  address | undefined) sanitize=$SANITIZER ;;
  none) sanitize= ;;
  *) echo "$0: SANITIZER is \"$SANITIZER\"; it can be address, undefined or none" >&2; exit 2 ;;
esac

mkdir -p "$OUT"
OUT=$(cd "$OUT" && pwd)
cmake -S . -B "$WORK" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_C_COMPILER="$CC" -DCMAKE_CXX_COMPILER="$CXX" \
  -DCMAKE_C_FLAGS="${CFLAGS:-}" -DLTSIM_FUZZ_COVERAGE="$(tr -s ' ' ';' <<<"${CXXFLAGS:-}" | sed 's/^;//; s/;$//')" \
  -DLTSIM_FUZZ_ENGINE="$(tr -s ' ' ';' <<<"$LIB_FUZZING_ENGINE")" -DLTSIM_SANITIZE="$sanitize"
cmake --build "$WORK" --target fuzz_targets

for program in "$WORK"/bin/fuzz-*; do
  name=${program##*/fuzz-}
  cp "$program" "$OUT/"
  for kind in dict options; do
    [ ! -e "fuzz/$name.$kind" ] || cp "fuzz/$name.$kind" "$OUT/fuzz-$name.$kind"
  done
  (cd "fuzz/corpus/$name" && cmake -E tar cf "$OUT/fuzz-${name}_seed_corpus.zip" --format=zip -- *)
done
