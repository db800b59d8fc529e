#!/usr/bin/env bash
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
# shellcheck source=scripts/common.sh
. "$root/scripts/common.sh"

usage() {
    cat <<'TEXT'
usage: ./run.sh [SCENE] [--no-install] [--build-dir DIR] [-h]

Builds lamella for this machine, runs a scene, plots and draws the result and says where everything is.

  SCENE            a scene file, or the name of a shipped scene (default: vortex_sheet/double-bubble-small)
  --no-install     do not install missing Debian packages
  --build-dir DIR  where to build (default: build/release)
TEXT
}

scene=
install=yes
build=$root/build/release
while [ $# -gt 0 ]; do
    case $1 in
        -h | --help) usage && exit 0 ;;
        --no-install) install=no ;;
        --build-dir)
            [ $# -ge 2 ] || misused "--build-dir needs a folder"
            build=$(absolute "$2")
            shift
            ;;
        --build-dir=*) build=$(absolute "${1#*=}") ;;
        -*) misused "unknown option $1" ;;
        *)
            [ -z "$scene" ] || misused "one scene at a time: $scene or $1?"
            scene=$1
            ;;
    esac
    shift
done
scene=${scene:-vortex_sheet/double-bubble-small}

# The run folder is named after the scene: bubble/coarsening-2d -> bubble-coarsening-2d, some/where/foam.toml -> foam.
if [ -f "$scene" ]; then
    name=$(basename "$scene" .toml)
else
    name=${scene//\//-}
fi
run=$root/runs/$name
lamella=$build/bin/lamella

[ "$install" = no ] || install_packages build
prepare_page "$install"
say "Building in $build"
configure release "$build" -DLAMELLA_NATIVE=ON -DLAMELLA_BUILD_APP=ON
cmake --build "$build" --target bin/lamella --parallel "$jobs" >&2

say "Running $scene"
"$lamella" run "$scene" --out "$run" --overwrite

say "Plotting"
"$lamella" plot "$run" >/dev/null

if [[ $("$lamella" version) == *parts*render* ]]; then
    say "Drawing the last frame"
    "$lamella" render "$run" --out "$run/picture.png"
fi

cat <<TEXT

Done.
  run folder   $run
  series       $run/series.csv
  ParaView     $run/frames.pvd
TEXT
find "$run/plots" \( -name '*.png' -o -name '*.svg' \) | sort | sed 's/^/  plot         /'
[ ! -f "$run/picture.png" ] || echo "  picture      $run/picture.png"
cat <<TEXT
  program      $lamella   (try: view $run, scenes, explain bubble)
TEXT
