# Sourced, from the project's root, by scripts that say where their time goes: "stage NAME COMMAND..." runs the command and
# notes its seconds. A name begins with the preset, if it has one ("release: build"); a stage has none within. The script
# that was called first ends with the table of all stages (scripts/times), those of the scripts that it calls among them.
if [ -z "${TWINMAP_TIMES:-}" ]; then
  export TWINMAP_TIMES=$PWD/build/times
  rm -rf "$TWINMAP_TIMES"
  mkdir -p "$TWINMAP_TIMES"
  echo "${0#./}" >"$TWINMAP_TIMES/command"
  trap 'code=$?; /usr/bin/python3 scripts/times || true; exit $code' EXIT
fi

stage() {
  local name=$1 code=0 TIMEFORMAT='%R %U %S'
  shift
  { time "$@" 2>&3 3>&-; } 3>&2 2>"$TWINMAP_TIMES/last" || code=$?
  printf '%s\t%s\t%s\n' "$name" "$code" "$(tail -n 1 "$TWINMAP_TIMES/last")" >>"$TWINMAP_TIMES/stages"
  return $code
}

# Where ctest writes what its tests took: --output-junit "$(junit NAME)", NAME that of its stage.
junit() {
  echo "$TWINMAP_TIMES/${1//\//+}.xml"
}
