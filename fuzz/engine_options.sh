# shellcheck shell=bash
# Shared by the scripts that start targets with their engine. To be sourced by bash in the project's root.

# engine_options NAME: sets the array `options` to what the engine is told of the target: its dictionary and its options.
engine_options() {
  local line
  options=()
  [ ! -e "fuzz/$1.dict" ] || options+=("-dict=fuzz/$1.dict")
  [ -e "fuzz/$1.options" ] || return 0
  while read -r line; do options+=("-$line"); done < <(sed -n 's/ //g; /^[a-z_]*=/p' "fuzz/$1.options")
}
