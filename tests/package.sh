#!/usr/bin/env bash
# Lifecycle test of the Debian package in an empty root directory: build, install, run, upgrade with a changed configuration,
# remove, purge. The host system is not changed.
#   tests/package.sh [PACKAGE.deb]     without an argument, cargo-deb builds the package
set -euo pipefail
root=$(readlink -f "$(dirname "$(readlink -f "$0")")/..")
cd "$root"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
    echo "package: BAD   $*" >&2
    exit 1
}

package=${1:-}
if [ -z "$package" ]; then
    # Installed under the target directory, so that an existing cargo-deb is left alone.
    tools=${CARGO_TARGET_DIR:-target}/tools
    command -v cargo-deb >/dev/null || [ -x "$tools/bin/cargo-deb" ] || cargo install --locked --quiet --root "$tools" cargo-deb
    PATH=$PATH:$tools/bin
    cargo build --release --locked --quiet
    # The licences of all linked crates, written where Cargo.toml expects them.
    python3 kiosk-config/debian/notices.py --output out/package/THIRD-PARTY
    python3 kiosk-config/debian/notices.py --debian-copyright --output out/package/copyright
    python3 kiosk-config/debian/notices.py --sbom --output out/package/sbom.cdx.json
    cargo-deb deb --no-build --output "$work/soffio.deb" >/dev/null
    package=$work/soffio.deb
fi
echo "package: $(dpkg-deb -f "$package" Package Version Architecture | xargs), $(($(stat -c %s "$package") / 1024)) KiB"

# An empty root with a package database. Dependencies are not checked here.
scratch=$work/root
mkdir -p "$scratch/var/lib/dpkg/updates" "$scratch/var/lib/dpkg/info"
touch "$scratch/var/lib/dpkg/status"
everything() { (cd "$scratch" && find . -path ./var/lib/dpkg -prune -o -path ./var/log -prune -o -print | sort); }
package_manager() {
    dpkg --root="$scratch" --log="$work/dpkg.log" --force-not-root --force-script-chrootless --force-depends --force-confold "$@" >>"$work/out" 2>&1 ||
        { tail -5 "$work/out" >&2; fail "dpkg $*"; }
}
everything >"$work/before"

package_manager --install "$package"
for file in usr/bin/soffio usr/lib/soffio/launch usr/lib/systemd/system/soffio.service etc/soffio/kiosk.toml \
    usr/share/soffio/exhibits/steel-fish/exhibit.toml usr/share/soffio/exhibits/steel-fish/breaths/normal.wav \
    usr/share/doc/soffio/README.md usr/share/doc/soffio/weston.ini usr/share/doc/soffio/copyright usr/share/doc/soffio/THIRD-PARTY usr/share/doc/soffio/sbom.cdx.json; do
    [ -f "$scratch/$file" ] || fail "$file is not installed"
done
[ -z "$(cd "$scratch" && find usr etc -type f -perm /022)" ] || fail "files writable by group or others"
[ -z "$(find "$scratch/etc/soffio/kiosk.toml" -perm /007)" ] || fail "everybody may read the hash of the PIN and the broker's password"
soffio=$scratch/usr/bin/soffio
# A released program has no symbols.
sections=$(readelf --section-headers --wide "$soffio")
[[ $sections != *.symtab* && $sections != *.debug_info* ]] || fail "the program is not stripped"
grep -q '^Format: https://www.debian.org/doc/packaging-manuals/copyright-format/1.0/' "$scratch/usr/share/doc/soffio/copyright" ||
    fail "its copyright file is not the one written by notices.py"
# Weak copyleft: its notice names the licence and where the source is.
grep -A 3 '^serialport ' "$scratch/usr/share/doc/soffio/THIRD-PARTY" | grep -q 'MPL-2.0' || fail "the notices do not name serialport's licence"
grep -q '"MPL-2.0"' "$scratch/usr/share/doc/soffio/sbom.cdx.json" || fail "the bill of materials does not name serialport's licence"
cmp "$scratch/etc/soffio/kiosk.toml" kiosk-config/kiosk.toml || fail "the installed configuration is not the shipped one"

# systemd accepts the unit. The compositor in ExecStart belongs to another package, so /bin/true replaces it.
if command -v systemd-analyze >/dev/null; then
    sed 's#^ExecStart=/usr/bin/cage #ExecStart=/bin/true #' "$scratch/usr/lib/systemd/system/soffio.service" >"$work/soffio.service"
    if ! systemd-analyze verify "$work/soffio.service" 2>"$work/verify" || [ -s "$work/verify" ]; then
        cat "$work/verify" >&2
        fail "the unit"
    fi
    # 0 is the most protected, 10 the least; --threshold is in tenths.
    systemd-analyze security --offline=true --threshold=30 "$work/soffio.service" >"$work/security" ||
        { tail -1 "$work/security" >&2; fail "the unit may do more than it needs: systemd-analyze security, bound 3.0"; }
    echo "package: $(tail -1 "$work/security")"
elif [ -n "${SOFFIO_REQUIRE_ALL:-}" ]; then
    fail "the unit cannot be verified without systemd-analyze: apt-get install systemd"
else
    echo "package: the unit is not verified: no systemd-analyze here" >&2
fi

# The installed program finds its exhibits and its configuration from any working directory.
mkdir "$work/elsewhere"
cd "$work/elsewhere"
"$soffio" check "$scratch"/usr/share/soffio/exhibits/* "$scratch/etc/soffio/kiosk.toml" 2>"$work/check" || { tail -20 "$work/check"; fail "an installed exhibit"; }
"$soffio" play terry-clock --seconds 1 | grep -q '"state_hash"' || fail "play does not find an exhibit"
env -u DISPLAY -u WAYLAND_DISPLAY "$soffio" doctor >"$work/doctor" 2>/dev/null || true
grep -q "configuration: $scratch/etc/soffio/kiosk.toml" "$work/doctor" || fail "doctor does not find the configuration"
grep -q 'exhibit terry-clock: valid' "$work/doctor" || fail "doctor does not find the exhibits"
"$scratch/usr/lib/soffio/launch" "$soffio" kiosk --help >/dev/null || fail "the launcher does not start the program"
cd "$root"

# An upgrade and a removal keep the configuration that the site has changed; a purge deletes it.
echo '# site setting' >>"$scratch/etc/soffio/kiosk.toml"
package_manager --install "$package"
grep -q '^# site setting' "$scratch/etc/soffio/kiosk.toml" || fail "an upgrade has overwritten the configuration"
mkdir -p "$scratch/var/lib/soffio/exhibits/own"
touch "$scratch/var/lib/soffio/state.json" "$scratch/var/lib/soffio/overrides.toml"
package_manager --remove soffio
if [ -e "$scratch/usr/bin/soffio" ] || [ ! -f "$scratch/etc/soffio/kiosk.toml" ]; then fail "removal"; fi
package_manager --purge soffio
if [ ! -d "$scratch/var/lib/soffio/exhibits/own" ] || [ -e "$scratch/var/lib/soffio/state.json" ] || [ -e "$scratch/var/lib/soffio/overrides.toml" ]; then fail "purge and /var/lib/soffio"; fi
rm -r "$scratch/var"/lib/soffio
everything >"$work/after"
diff "$work/before" "$work/after" || fail "files are left after the purge"
echo "package: good  installed, used, upgraded, removed and purged: no file is left"
