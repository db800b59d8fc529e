# shellcheck shell=bash
# What run.sh and test.sh share; sourced, not run. Needs `root`: the top of the source tree.
: "${root:?}"

say() { printf '\n==> %s\n' "$*" >&2; }
die() {
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 1
}

# Used wrongly: how it is meant, and exit code 2.
misused() {
    usage >&2
    printf '%s: %s\n' "$(basename "$0")" "$*" >&2
    exit 2
}

jobs=$(nproc)
export jobs

# needed_packages KIND...: the packages that scripts/debian-packages.txt lists under these words.
needed_packages() {
    local kind package rest
    while read -r kind package rest; do
        case " $* " in *" $kind "*) echo "$package" ;; esac
    done < <(grep -v '^#' "$root/scripts/debian-packages.txt")
}

# missing_packages KIND...: those of them that are not installed. Asks dpkg only, so it is quick.
missing_packages() {
    local package
    for package in $(needed_packages "$@"); do
        case $(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null) in
            installed) ;;
            *) echo "$package" ;;
        esac
    done
}

# install_packages KIND...: makes sure that these are there, with apt, as root or with sudo.
install_packages() {
    if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
        die "this is no Debian system: install the libraries of scripts/debian-packages.txt yourself and pass --no-install"
    fi
    local missing apt_install as_root=()
    mapfile -t missing < <(missing_packages "$@")
    [ ${#missing[@]} -gt 0 ] || return 0
    apt_install=(env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}")
    if [ "$(id -u)" -ne 0 ]; then
        command -v sudo >/dev/null ||
            die "packages are missing and there is no sudo; as root run: apt-get install -y ${missing[*]}"
        as_root=(sudo)
    fi
    say "Installing ${missing[*]}"
    # The package lists of a fresh machine may be missing or old: fetch them and try once more.
    "${as_root[@]}" "${apt_install[@]}" ||
        { "${as_root[@]}" apt-get update && "${as_root[@]}" "${apt_install[@]}"; } ||
        die "apt could not install the packages (see above); install them yourself and pass --no-install: ${missing[*]}"
}

# install_optional KIND WITHOUT: installs packages that one can do without, or says what is then missing.
install_optional() {
    (install_packages "$1") || say "Going on without: $2"
}

# prepare_page yes|no: what the page of `lamella view` is built from, node and the packages that web/package-lock.json
# names; "no": only if npm is there already. Nothing else needs them, so it never fails.
prepare_page() {
    local without="the page of lamella view"
    # An npm that is no Debian package will do, and apt would take it away.
    if [ "$1" = yes ] && ! command -v npm >/dev/null; then install_optional page "$without"; fi
    [ ! "$root/web/node_modules/.package-lock.json" -nt "$root/web/package-lock.json" ] || return 0
    command -v npm >/dev/null || return 0
    say "Fetching the packages of the page"
    (cd "$root/web" && npm ci --ignore-scripts --no-audit --no-fund >&2) || say "Going on without: $without"
}

# configure PRESET FOLDER [CMAKE OPTION...]
configure() {
    local preset=$1 folder=$2 launcher=()
    shift 2
    command -v cmake >/dev/null || die "cmake is missing; run without --no-install, or install it"
    if command -v ccache >/dev/null; then
        launcher=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    fi
    mkdir -p "$folder"
    (cd "$root" && cmake --preset "$preset" -B "$folder" "${launcher[@]}" "$@") >"$folder/configure.log" 2>&1 || {
        cat "$folder/configure.log" >&2
        die "configuring failed; the output above is in $folder/configure.log"
    }
}

# absolute PATH: the same place as seen from anywhere.
absolute() { realpath -m -- "$1"; }
