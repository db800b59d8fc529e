#!/usr/bin/env bash
# Makes every picture of the gallery and its page. It runs each scene, most of them in their small version, and the
# whole of it takes about an hour, half of it for the foam mountain; what a picture needs is in the list below.
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

# name | scene and options of lamella run | frame | options of lamella render | what it is (nothing: not on the page)
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
bursting-in-flight|vortex_sheet/bursting-in-flight-small|1||A bubble flies towards another; it bursts, and its air flies on as a vortex ring
cube-oscillation|vortex_sheet/cube-oscillation-small|17||A cube of soap film swings around the sphere
octahedron|vortex_sheet/octahedron-small|last|--exposure 0.9|Films on an octahedron of wire
vortices-on-a-bubble|vortex_particle/sphere-vortices-small|40|--environment window|Vortices of both signs stir the liquid of a bubble
stick|vortex_particle/stick-small --set vortex_particle.particles_in_frames=true|54|--camera -90,58,1.33|A stick was dragged through a film that is thicker on one side
vortex-street|vortex_particle/street-small|60||A film streams around a disk: a street of vortices
water-strider|vortex_particle/strider-small|40||Two legs of a water strider row through a film
springing-flat|vortex_particle/hemisphere-small|8||Half a bubble on a ring lets its air out and springs flat
bursting-half-bubble|vortex_particle/half-bubble-pop-small|22||The upper half of a bubble in a ring has burst, the lower one springs through
frame-drains|vortex_particle/frame-small|12||Liquid runs from film to film in a wire cube
swinging-cube|vortex_particle/cube-oscillation-small|20||A bubble that began as a cube swings
giant-bubble|vortex_particle/giant-bubble-small|30||A giant bubble that was blown askew swings
joining-bubbles|vortex_particle/double-bubble-small|20||Two bubbles with a vortex each have flown together
billowing-film|vortex_particle/deforming-rectangle-small|12|--camera -62,-20,1.2|A film that is thick above comes down and billows
fingers|vortex_particle/rayleigh-taylor-small --set vortex_particle.particles_in_frames=true|36|--camera -90,58,1.3|Thick film comes down in fingers through thin film
around-a-catenoid|vortex_particle/catenoid-small|40|--camera -62,24|A flow around a catenoid carries a vortex along
drainage-of-a-square|vortex_particle/drainage-small|50||A film drains until its surfactant carries it
drainage-of-a-disk|vortex_particle/drainage-disk-small|50||The same in a ring
leapfrog|vortex_particle/leapfrog-small|60|--field vorticity --camera -90,90,0.92|Two pairs of vortices run one through the other
taylor-vortices|vortex_particle/taylor-vortices-small|40|--field vorticity --camera -90,90,1.25|Two Taylor vortices part
rossby-haurwitz|vortex_particle/rossby-haurwitz-small|20|--field vorticity|A Rossby-Haurwitz wave on a bubble that turns
draining-bubble|melp/drainage-small|20||The liquid of a floating bubble sinks
equalisation|melp/equalisation-small|10|--environment window|Uneven liquid pulls itself even
bubble-at-rest|melp/bubble-at-rest-small|2||A bubble at rest
oscillating-bubble|melp/oscillating-bubble-small|0||A bubble pulled out of shape
double-bubble-of-particles|melp/double-bubble-small|last|--environment window|Two bubbles of particles share a film
film-drainage|melp/film-drainage-small|10||An upright film in a frame drains
fingers-of-particles|melp/rayleigh-taylor-small|14||Thick film above thin film, made of particles, sinks in fingers
deforming-rectangle|melp/deforming-rectangle-small|24||The upper side of a frame swings to the front, and the film with it
black-spots|melp/black-spots-small|12||Black spots rise in a film whose frame swings out
stirred-film|melp/stirred-film-small|10|--camera -90,58,1.15|A whirl of air has stirred a film
heated-bubble|melp/heated-bubble-small|16|--field temperature --camera 20,-10|A warm spot beside a bubble sends its film up
half-bubble|melp/half-bubble-small|10||Half a bubble on a plate, in the wind
ball-on-a-film|melp/ball-on-film-small|5||A ball has fallen on a film, which catches it
stick-of-particles|melp/stick-small|18|--camera -60,35 --exposure 2|A stick was dragged through a film that is thicker above
bursting-disk|melp/burst-disk-small|7||A film in a ring was pricked: the hole's edge gathers the liquid
bursting-giant|melp/giant-bubble-small|4||A giant bubble, pricked from the right, a few milliseconds later
different-sizes|melp/different-sizes-small|last|--camera -90,5|Two bubbles have come down on half a bubble, and lean
four-bubbles|melp/four-bubbles-small|6|--exposure 0.8|Four bubbles have flown together
thirteen-bubbles|melp/thirteen-bubbles|12|--exposure 0.6|Thirteen joined bubbles drain over warm air
rt-double-bubble|melp/rt-double-bubble-small|4|--environment window|Heavy liquid sinks through the film between two bubbles
foam-mountain|melp/foam-mountain-small|12||Bubbles pour from above, pile up on a plate and pop one after the other
foam-mountain-of-300|melp/foam-mountain|last|--exposure 0.4 --ground --camera -62,12,1.25|Three hundred bubbles have poured, and a hundred have popped
catenoid|equilibrium/catenoid-0.8-small|last||The catenoid between two rings
catenoid-0.4|equilibrium/catenoid-0.4-small|last||The same between rings that are near
catenoid-1.3|equilibrium/catenoid-1.3-small|last||The same, nearly as far apart as rings can be
catenoid-unstable|equilibrium/catenoid-unstable-small|last|--environment window|The other catenoid, with the narrow neck: a saddle
catenoid-collapse|equilibrium/catenoid-collapse-small|last||Rings too far apart: two disks are left
frame-tetrahedron|equilibrium/frame-tetrahedron-small|last|--camera -40,22|Films on a tetrahedron of wire: Plateau's laws
frame-cube|equilibrium/frame-cube-small|last|--ground|Films on a cube of wire, on a table
frame-octahedron-cone|equilibrium/frame-octahedron-cone-small|last||The cone on an octahedron balances, and is not stable
frame-octahedron|equilibrium/frame-octahedron-small|last|--environment window|Films on an octahedron of wire, at rest
double-bubble-radii|equilibrium/melp-double-radii-0.02-small|last||A small bubble on a large one: outer films of radii 2 and 5 cm
double-bubble-radii-0.025|equilibrium/melp-double-radii-0.025-small|last||Outer films of radii 2.5 and 5 cm
double-bubble-radii-0.035|equilibrium/melp-double-radii-0.035-small|last||Outer films of radii 3.5 and 5 cm
double-bubble-radii-0.04|equilibrium/melp-double-radii-0.04-small|last||Outer films of radii 4 and 5 cm
double-bubble-radii-0.05|equilibrium/melp-double-radii-0.05-small|last||Outer films of radii 5 and 5 cm
double-bubble-1|equilibrium/double-bubble-1-small|last|--environment window|A double bubble of volumes 1 and 1
double-bubble-volumes|equilibrium/double-bubble-0.5-small|last|--environment window|Volumes 1 and 1/2, in the light of windows
double-bubble-0.125|equilibrium/double-bubble-0.125-small|last|--environment window|A double bubble of volumes 1 and 1/8
triple-bubble|equilibrium/triple-bubble-small|last|--camera -50,40|Three bubbles of equal volume
quadruple-bubble|equilibrium/quadruple-bubble-small|last||Four bubbles of equal volume
cluster-6|equilibrium/cluster-6-small|last|--environment window --exposure 0.8|Six bubbles of equal volume
cluster-13|equilibrium/cluster-13-small|last|--exposure 0.7|Thirteen bubbles: one inside, twelve around it
inflate-and-pop|equilibrium/inflate-and-pop-small|last|--ground|Bubbles inflated, others popped
kelvin|equilibrium/kelvin-small|last|--exposure 0.8|Kelvin's foam, sixteen bubbles
weaire-phelan|equilibrium/weaire-phelan-small|last|--images 1 --exposure 0.7|The foam of Weaire and Phelan: the eight bubbles that repeat
coarsening-2d|bubble/coarsening-2d-small|last|--field radius|A flat foam coarsens: the large grow, the small vanish
coarsening-3d|bubble/coarsening-3d-small|last|--ground|A foam coarsens
flow-2d|bubble/flow-2d-small|last|--field velocity|A flat foam flows
phase-separation|bubble/phase-separation-small|last||Bubbles gather and leave liquid between them
paper-cube|vortex_sheet/paper-cube --until 0.5|5||The cube of the paper's table, half a unit of time after its start
paper-double-bubble|vortex_sheet/paper-double-bubble --until 0.5|5|--camera -80,25|The double bubble of the paper's table
paper-cluster-popping|vortex_sheet/paper-cluster-popping --until 1|1|--exposure 0.8|The ten bubbles of the paper's table before the first bursts
double-bubble-equal|equilibrium/double-bubble-small|last|--environment daylight --camera -75,20|Two bubbles of one size, at rest, under a hazy sky
melp-double-volumes-0.02|equilibrium/melp-double-volumes-0.02-small|last||Bubbles that had radii of 2 and 5 cm before they met
melp-double-volumes-0.025|equilibrium/melp-double-volumes-0.025-small|last||Bubbles that had radii of 2.5 and 5 cm before they met
melp-double-volumes-0.035|equilibrium/melp-double-volumes-0.035-small|last||Bubbles that had radii of 3.5 and 5 cm before they met
melp-double-volumes-0.04|equilibrium/melp-double-volumes-0.04-small|last||Bubbles that had radii of 4 and 5 cm before they met
melp-double-volumes-0.05|equilibrium/melp-double-volumes-0.05-small|last||Bubbles that had radii of 5 and 5 cm before they met
cluster-5|equilibrium/cluster-5-small|last|--exposure 0.9|Five bubbles of equal volume
cluster-8|equilibrium/cluster-8-small|last|--exposure 0.8|Eight bubbles of equal volume
cluster-10|equilibrium/cluster-10-small|last|--environment window --exposure 0.7|Ten bubbles of equal volume
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
    run=${scene%% *}
    run=$runs/${run//\//-}
    # shellcheck disable=SC2086  # scene and options are words
    [ -f "$run/frames.pvd" ] || "$program" run $scene --out "$run" --overwrite --progress none </dev/null
    case $options in *--size*) ;; *) options="$options --size $size" ;; esac
    case $options in *--samples*) ;; *) options="$options --samples $samples" ;; esac
    # shellcheck disable=SC2086  # options are words
    "$program" render "$run" --frame "$frame" --progress none --out "$runs/$name.png" \
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
        [ -n "$text" ] && [ -f "$here/$name.jpg" ] || continue
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
