# shellcheck shell=bash
# System requirements, sourced by ./kiosk and ./check: finds missing packages, prints what each is for, installs them, and
# checks free disk space and memory.

missing=()
wanted=()
# All requested packages, as package:file (the file or command that shows that the package is installed).
requested=()

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

# Succeeds if one of the files exists. A pattern without a match is passed on unexpanded.
any_file() {
    local file
    for file in "$@"; do
        [ -e "$file" ] && return 0
    done
    return 1
}

# Succeeds if a command, header, shared library, Vulkan driver or font is installed.
present() {
    case "$1" in
        *.h) [ -e "/usr/include/$1" ] ;;
        # Not grep -q: it closes the pipe early, and pipefail then reports ldconfig as failed.
        *.so.*) { ldconfig -p || /sbin/ldconfig -p; } 2>/dev/null | grep -F "$1" >/dev/null ;;
        lvp_icd) any_file /usr/share/vulkan/icd.d/*.json /etc/vulkan/icd.d/*.json ;;
        DejaVu*) any_file /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf /usr/share/fonts/truetype/noto/NotoSansArabic* ;;
        Nanum*) any_file /usr/share/fonts/truetype/nanum/*.ttf /usr/share/fonts/opentype/noto/*CJK* ;;
        # Servers are installed in sbin, which is not in a user's PATH.
        *) PATH=$PATH:/usr/sbin:/sbin command -v "$1" >/dev/null 2>&1 ;;
    esac
}

# need "why" package:file …: required packages.
need() { find_missing missing "$@"; }

# want "why" package:file …: optional packages. Each is installed alone, so that one failure does not prevent the others.
want() { find_missing wanted "$@"; }

find_missing() {
    local -n list=$1
    local why=$2 pair
    shift 2
    requested+=("$@")
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

# Ends the script if a requested package is still missing.
require_all() {
    local pair absent=()
    for pair in "${requested[@]}"; do
        present "${pair#*:}" || absent+=("${pair%%:*}")
    done
    [ ${#absent[@]} -eq 0 ] && return 0
    say "still missing: ${absent[*]}. Some checks need them: install them, then run this again."
    exit 3
}

# require_space FOLDER DISK_MB MEMORY_MB "task": ends the script if free disk space or memory is too small for the task.
require_space() {
    local folder=$1 disk=$2 memory=$3 task=$4 free short=
    # A folder that does not exist yet will be created in its nearest existing parent.
    while [ ! -d "$folder" ]; do folder=$(dirname "$folder"); done
    free=$(df -Pm "$folder" | awk 'NR == 2 { print $4 }')
    if [ "${free:-$disk}" -lt "$disk" ]; then
        say "$task needs about $disk MB of disk, and $(readlink -f "$folder") has $free MB free. Make room, or set CARGO_TARGET_DIR to a folder on another disk."
        short=1
    fi
    # Free swap counts as memory: a build with swap is slow, but succeeds.
    free=$(awk '/^(MemAvailable|SwapFree):/ { kb += $2 } END { if (NR) print int(kb / 1024) }' /proc/meminfo 2>/dev/null || true)
    if [ "${free:-$memory}" -lt "$memory" ]; then
        say "$task needs about $memory MB of memory, and $free MB are available. Close other programs, or add swap."
        short=1
    fi
    [ -n "$short" ] || return 0
    [ -n "${SOFFIO_ANYWAY:-}" ] || { say "Set SOFFIO_ANYWAY=1 to continue anyway."; exit 3; }
}
