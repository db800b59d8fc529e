#!/usr/bin/env bash
# Makes every picture of the gallery and its page. It runs each scene, so it takes some minutes; what a scene
# needs is in the list below.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

usage() {
    cat <<'TEXT'
usage: docs/gallery/make.sh [--program FILE] [--runs DIR] [--size WxH] [--samples N] [NAME...]

Runs the scenes of the gallery, renders them into docs/gallery/NAME.jpg and writes docs/gallery/README.md.

  NAME             only these pictures, and the page
  --program FILE   lamella (default: build/release/bin/lamella)
  --runs DIR       where runs are kept, and used again if they are there (default: runs/gallery)
  --size WxH       of the pictures (default: 640x480)
  --samples N      rays per pixel (default: 64)

Needs ffmpeg, which makes the pictures small.
TEXT
}

program=$here/../../build/release/bin/lamella
runs=$here/../../runs/gallery
size=640x480
samples=64
chosen=()
while [ $# -gt 0 ]; do
    case $1 in
        -h | --help) usage && exit 0 ;;
        --program) program=$2 && shift ;;
        --runs) runs=$2 && shift ;;
        --size) size=$2 && shift ;;
        --samples) samples=$2 && shift ;;
        -*) echo "unknown option $1" >&2 && exit 2 ;;
        *) chosen+=("$1") ;;
    esac
    shift
done

# name | scene | frame | options of lamella render | what it is (nothing: not on the page)
pictures() {
    cat <<'TEXT'
opening|equilibrium/triple-bubble-small|last|--camera -50,40,1.15 --size 1200x600|
double-bubble|vortex_sheet/double-bubble-small|last||Two bubbles share a film: the standard double bubble, where a swing has come to rest
two-bubbles-meet|vortex_sheet/two-bubbles-meet-small|8||Two bubbles touch and pull each other together
pulling-apart|vortex_sheet/pulling-apart-small|16||A double bubble pulled by its ends
bubble-in-ring|vortex_sheet/bubble-in-ring-small|20|--exposure 0.9|A bubble without its partition swings
blowing|vortex_sheet/blowing-small|5||A film on a ring, blown into a bubble
sweeping-ring|vortex_sheet/sweeping-ring-small|6||A ring sweeps through air and leaves a bubble
catenoid-pinching|vortex_sheet/catenoid-pinching-small|32||A film between two rings, drawn too far apart, pinches
carousel|vortex_sheet/carousel-small|10|--camera -75,35|Bubbles carried round
cluster-popping|vortex_sheet/cluster-popping-small|10|--exposure 0.8|A cluster whose bubbles pop one after the other
cube-oscillation|vortex_sheet/cube-oscillation-small|17||A cube of soap film swings around the sphere
octahedron|vortex_sheet/octahedron-small|last|--exposure 0.9|Films on an octahedron of wire
catenoid|equilibrium/catenoid-0.8-small|last||The catenoid between two rings
frame-tetrahedron|equilibrium/frame-tetrahedron-small|last|--camera -40,22|Films on a tetrahedron of wire: Plateau's laws
frame-cube|equilibrium/frame-cube-small|last|--ground|Films on a cube of wire, on a table
frame-octahedron|equilibrium/frame-octahedron-small|last|--environment window|Films on an octahedron of wire, at rest
double-bubble-radii|equilibrium/melp-double-radii-0.02-small|last||A small bubble on a large one
double-bubble-volumes|equilibrium/double-bubble-0.5-small|last|--environment window|A double bubble of volumes 1 and 1/2, in the light of windows
triple-bubble|equilibrium/triple-bubble-small|last|--camera -50,40|Three bubbles of equal volume
quadruple-bubble|equilibrium/quadruple-bubble-small|last||Four bubbles of equal volume
cluster-6|equilibrium/cluster-6-small|last|--environment window --exposure 0.8|Six bubbles of equal volume
cluster-13|equilibrium/cluster-13-small|last|--exposure 0.7|Thirteen bubbles: one inside, twelve around it
inflate-and-pop|equilibrium/inflate-and-pop-small|last|--ground|Bubbles inflated, others popped
kelvin|equilibrium/kelvin-small|last|--exposure 0.8|Kelvin's foam, eight unit cells
weaire-phelan|equilibrium/weaire-phelan-small|last|--exposure 0.7|The foam of Weaire and Phelan, eight unit cells
coarsening-2d|bubble/coarsening-2d-small|last|--field radius|A flat foam coarsens: the large grow, the small vanish
coarsening-3d|bubble/coarsening-3d-small|last|--ground|A foam coarsens
flow-2d|bubble/flow-2d-small|last|--field velocity|A flat foam flows
phase-separation|bubble/phase-separation-small|last||Bubbles gather and leave liquid between them
TEXT
}

wanted() {
    [ ${#chosen[@]} -eq 0 ] && return 0
    local name
    for name in "${chosen[@]}"; do [ "$name" != "$1" ] || return 0; done
    return 1
}

mkdir -p "$runs"
while IFS='|' read -r name scene frame options text; do
    wanted "$name" || continue
    run=$runs/${scene//\//-}
    [ -f "$run/frames.pvd" ] || "$program" run "$scene" --out "$run" --overwrite --progress none </dev/null
    case $options in *--size*) ;; *) options="$options --size $size" ;; esac
    # shellcheck disable=SC2086  # options are words
    "$program" render "$run" --frame "$frame" --samples "$samples" --progress none --out "$runs/$name.png" \
        $options </dev/null
    ffmpeg -nostdin -loglevel error -y -i "$runs/$name.png" -q:v 2 "$here/$name.jpg"
done < <(pictures)
{
    echo "# Gallery"
    echo
    echo "Every picture is made by \`lamella run\` and \`lamella render\` from a shipped scene; [make.sh](make.sh) makes them all."
    echo "Films of which no thickness is known are drawn as if they had drained for a while ([rendering](../rendering.md))."
    echo
    echo "| | | |"
    echo "|---|---|---|"
    row="|"
    count=0
    while IFS='|' read -r name scene frame options text; do
        [ -n "$text" ] || continue
        row+=" ![$text]($name.jpg) $text: \`$scene\`${options:+, \`$options\`} |"
        count=$((count + 1))
        if [ $((count % 3)) -eq 0 ]; then
            echo "$row"
            row="|"
        fi
    done < <(pictures)
    while [ $((count % 3)) -ne 0 ]; do
        row+=" |"
        count=$((count + 1))
    done
    [ "$row" = "|" ] || echo "$row"
} >"$here/README.md"
