# Shared by ./kiosk and ./check: finds which system packages are missing, says why they are wanted, installs them.
# Sourced, not run.

missing=()
wanted=()

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
        *) command -v "$1" >/dev/null 2>&1 ;;
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
