# shellcheck shell=bash
# Shared by ./kiosk and ./check: finds which system packages are missing, says why they are wanted, installs them; looks
# whether disk and memory are enough.
# Sourced, not run.

missing=()
wanted=()
# Package:witness of all that was asked for.
asked_for=()

say() { printf 'soffio: %s\n' "$*" >&2; }

need_rust() {
    command -v cargo >/dev/null 2>&1 || PATH="$HOME/.cargo/bin:$PATH"
    if ! command -v cargo >/dev/null 2>&1; then
        say "Rust is missing. Install it with rustup (https://rustup.rs), then run this again."
        exit 3
    fi
    if [ "$(printf '%s\n' 1.95 "$(cargo --version | cut -d' ' -f2)" | sort -V | head -1)" != 1.95 ]; then
        say "this needs Rust 1.95 or newer, found $(cargo --version). Run: rustup update stable"
        exit 3
    fi
}

# Is any of these files there? (A pattern that matches nothing stays as it is.)
any() {
    local file
    for file in "$@"; do
        [ -e "$file" ] && return 0
    done
    return 1
}

# Is a command, header, shared library, Vulkan driver or font there?
present() {
    case "$1" in
        *.h) [ -e "/usr/include/$1" ] ;;
        # Not grep -q: it would end ldconfig early, which pipefail takes for a failure.
        *.so.*) { ldconfig -p || /sbin/ldconfig -p; } 2>/dev/null | grep -F "$1" >/dev/null ;;
        lvp_icd) any /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json ;;
        DejaVu*) any /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf /usr/share/fonts/truetype/noto/NotoSansArabic* ;;
        Nanum*) any /usr/share/fonts/truetype/nanum/*.ttf /usr/share/fonts/opentype/noto/*CJK* ;;
        # Servers lie where only root looks.
        *) PATH=$PATH:/usr/sbin:/sbin command -v "$1" >/dev/null 2>&1 ;;
    esac
}

# need "why" package:witness …: what the kiosk does not run without.
need() { look missing "$@"; }

# want "why" package:witness …: what it runs without, but not as well. One of these that cannot be had keeps no other away.
want() { look wanted "$@"; }

look() {
    local -n list=$1
    local why=$2 pair
    shift 2
    asked_for+=("$@")
    for pair in "$@"; do
        if ! present "${pair#*:}"; then
            local package=${pair%%:*}
            [ "$package" = cc ] && package=build-essential
            list+=("$package")
            say "missing $package, wanted $why"
        fi
    done
}

install_missing() {
    local package
    install_all "${missing[@]}"
    for package in "${wanted[@]}"; do
        install_all "$package"
    done
}

install_all() {
    [ $# -eq 0 ] && return 0
    local as_root=()
    [ "$(id -u)" -eq 0 ] || as_root=(sudo)
    if ! command -v apt-get >/dev/null 2>&1 || { [ ${#as_root[@]} -gt 0 ] && ! command -v sudo >/dev/null 2>&1; }; then
        say "please install with your package manager: $*"
        return 0
    fi
    say "installing: $*"
    local log
    log=$(mktemp)
    if ! { "${as_root[@]}" apt-get update -qq && DEBIAN_FRONTEND=noninteractive "${as_root[@]}" apt-get \
            -o DPkg::Lock::Timeout=400 install -y -qq --no-install-recommends "$@"; } >"$log" 2>&1; then
        tail -5 "$log" >&2
        say "that did not work; the full log is $log. Install by hand: $*"
        return 0
    fi
    rm -f "$log"
}

# Ends the script where something that was asked for could not be had.
all_there() {
    local pair absent=()
    for pair in "${asked_for[@]}"; do
        present "${pair#*:}" || absent+=("${pair%%:*}")
    done
    [ ${#absent[@]} -eq 0 ] && return 0
    say "still missing: ${absent[*]}. Without them a part of the check would prove nothing: install them, then run this again."
    exit 3
}

# Ends the script where disk or memory are not enough: enough FOLDER MB-OF-DISK MB-OF-MEMORY "for what".
enough() {
    local folder=$1 disk=$2 memory=$3 what=$4 free short=
    # What is not there yet comes into the folder above it.
    while [ ! -d "$folder" ]; do folder=$(dirname "$folder"); done
    free=$(df -Pm "$folder" | awk 'NR == 2 { print $4 }')
    if [ "${free:-$disk}" -lt "$disk" ]; then
        say "$what needs about $disk MB of disk, and $(readlink -f "$folder") has $free MB free. Make room, or set CARGO_TARGET_DIR to a folder on another disk."
        short=1
    fi
    # Swap counts: it is slow, but it works.
    free=$(awk '/^(MemAvailable|SwapFree):/ { kb += $2 } END { if (NR) print int(kb / 1024) }' /proc/meminfo 2>/dev/null || true)
    if [ "${free:-$memory}" -lt "$memory" ]; then
        say "$what needs about $memory MB of memory, and $free MB are available. End other programs, or add swap."
        short=1
    fi
    [ -n "$short" ] || return 0
    [ -n "${SOFFIO_ANYWAY:-}" ] || { say "SOFFIO_ANYWAY=1 goes on all the same."; exit 3; }
}
