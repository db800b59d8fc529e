#!/usr/bin/env bash
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=scripts/common.sh
. "$root/scripts/common.sh"

usage() {
    cat <<'TEXT'
usage: ./test.sh [--full] [--no-install] [--build-dir DIR] [-h]

Builds lamella for this machine and runs its tests.

  --full           also the tests that take minutes, the unit and property tests under the address,
                   undefined-behavior and thread sanitizers, and every fuzz target for a minute
  --no-install     do not install missing Debian packages
  --build-dir DIR  where to build (default: build/release); --full builds debug, tsan and fuzz beside it
TEXT
}

full=no
install=yes
build=$root/build/release
while [ $# -gt 0 ]; do
    case $1 in
        -h | --help) usage && exit 0 ;;
        --full) full=yes ;;
        --no-install) install=no ;;
        --build-dir)
            [ $# -ge 2 ] || misused "--build-dir needs a folder"
            build=$(absolute "$2")
            shift
            ;;
        --build-dir=*) build=$(absolute "${1#*=}") ;;
        *) misused "unknown option $1" ;;
    esac
    shift
done
beside=$(dirname "$build")
fuzz_seconds=60

build_all() { cmake --build "$1" --parallel "$jobs" >&2; }

# run_tests FOLDER [CTEST OPTION...]
run_tests() {
    local folder=$1
    shift
    ctest --test-dir "$folder" --output-on-failure --no-tests=error --parallel "$jobs" "$@"
}

# sanitized PRESET: the unit and property tests, built with that preset's sanitizers.
sanitized() {
    say "Building and testing with the sanitizers of preset $1"
    configure "$1" "$beside/$1"
    build_all "$beside/$1"
    run_tests "$beside/$1" --label-regex '^(unit|property)$' --label-exclude '^full$'
}

# Each fuzz target for a minute, from its seeds; what it finds lies in findings/ of the build folder.
fuzz() {
    local folder=$beside/fuzz target name inputs
    say "Fuzzing, $fuzz_seconds s per target"
    configure fuzz "$folder"
    build_all "$folder"
    mkdir -p "$folder/findings"
    for target in "$folder"/bin/fuzz/*_fuzz; do
        [ -x "$target" ] || die "no fuzz target was built"
        name=$(basename "$target")
        inputs=("$folder/corpus/$name" "$root/tests/fuzz/corpus/$name")  # new ones go to the first
        mkdir -p "${inputs[0]}"
        [ -d "${inputs[1]}" ] || unset 'inputs[1]'
        say "$name"
        "$target" -max_total_time=$fuzz_seconds -rss_limit_mb=2048 -timeout=10 -print_final_stats=1 \
            -artifact_prefix="$folder/findings/$name-" "${inputs[@]}" \
            >"$folder/$name.log" 2>&1 || {
            tail -50 "$folder/$name.log" >&2
            die "$name found something; the input is in $folder/findings, the report in $folder/$name.log"
        }
        grep -E 'stat::(number_of_executed_units|average_exec_per_sec|peak_rss_mb)' "$folder/$name.log" || true
    done
}

if [ "$install" = yes ]; then
    install_packages build test
    [ "$full" = no ] || install_packages full
    install_optional browser "the tests of the page"
fi
prepare_page "$install"

say "Building in $build"
configure release "$build" -DLAMELLA_NATIVE=ON -DLAMELLA_BUILD_APP=ON -DLAMELLA_BUILD_TESTS=ON \
    -DLAMELLA_BUILD_BENCHMARKS=ON
build_all "$build"

say "Testing"
if [ "$full" = no ]; then
    run_tests "$build" --label-exclude '^full$'
else
    run_tests "$build"
    sanitized debug
    sanitized tsan
    fuzz
fi
say "All tests passed"
[ -d "$root/web/node_modules/esbuild" ] || say "Not tested: the page of lamella view, which npm was not there to build"
[ -x "${CHROMIUM:-/usr/bin/chromium}" ] || say "Not tested: the page in a browser; there is no chromium"
