#!/bin/sh
# Installs scotopic as a system service: the program, the unit, the udev rules, a user of its own, and settings to edit.
# Asks nothing; prints what it did and what is left to you. Works on Raspberry Pi OS and on any other system with systemd.
set -eu

usage() {
    cat <<'END'
Usage: packaging/install.sh [OPTIONS]

  --program FILE             the program to install [default: target/release/scotopic]
  --mount VID:PID:SERIAL     USB adapter of the mount, for the udev rule: 0403:6001:A50285BI
  --handbox VID:PID:SERIAL   USB adapter of the tapped hand controller
  --uninstall                remove what was installed; settings and what was learnt stay
  --purge                    with --uninstall: remove these too
  --help                     print this

PREFIX (default /usr/local) and DESTDIR (default empty) come from the environment. With DESTDIR nothing of the running system
is touched: no user is made, no service is enabled.

Examples:
  cargo build --release && sudo packaging/install.sh --mount 0403:6001:A50285BI
  DESTDIR=/tmp/package PREFIX=/usr packaging/install.sh --program ./scotopic
  sudo packaging/install.sh --uninstall
END
}

wrong() {
    echo "install.sh: $1" >&2
    exit 2
}

here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
PREFIX=${PREFIX:-/usr/local}
DESTDIR=${DESTDIR:-}
program=$here/../target/release/scotopic
mount='' handbox='' uninstall=no purge=no

while [ $# -gt 0 ]; do
    case $1 in
        --program | --mount | --handbox)
            [ $# -ge 2 ] || wrong "$1 needs a value"
            case $1 in
                --program) program=$2 ;;
                --mount) mount=$2 ;;
                --handbox) handbox=$2 ;;
            esac
            shift
            ;;
        --uninstall) uninstall=yes ;;
        --purge) purge=yes ;;
        --help) usage && exit 0 ;;
        *) wrong "unknown option $1 (--help lists them)" ;;
    esac
    shift
done

# Letters that would mean something to sed, udev or systemd have no place in these.
case $PREFIX in
    /*) ;;
    *) wrong "PREFIX=$PREFIX is no absolute path" ;;
esac
case $PREFIX in
    *[!A-Za-z0-9/._+-]*) wrong "PREFIX=$PREFIX: use letters, digits and /._+- only" ;;
esac
for adapter in "$mount" "$handbox"; do
    case $adapter in
        '') ;;
        [0-9a-f][0-9a-f][0-9a-f][0-9a-f]:[0-9a-f][0-9a-f][0-9a-f][0-9a-f]:?*)
            case ${adapter#*:*:} in
                *[!A-Za-z0-9._-]*) wrong "'$adapter': the serial number has letters, digits and ._- only" ;;
            esac
            ;;
        *) wrong "'$adapter' is no VID:PID:SERIAL such as 0403:6001:A50285BI (four hex digits in small letters, twice)" ;;
    esac
done
[ -z "$mount" ] || [ "$mount" != "$handbox" ] || wrong "mount and hand controller cannot be the same adapter ($mount)"
[ -n "$DESTDIR" ] || [ "$(id -u)" -eq 0 ] || wrong "only root may do this: sudo $0, or set DESTDIR for a package"

bin=$PREFIX/bin/scotopic
docs=$PREFIX/share/doc/scotopic
unit=/etc/systemd/system/scotopic.service
rules=/etc/udev/rules.d/70-scotopic.rules
users=/etc/sysusers.d/scotopic.conf
settings=/etc/scotopic/settings.toml

running() { [ -z "$DESTDIR" ] && command -v "$1" >/dev/null; }
did() { echo "  $1"; }

reload() {
    if running systemctl; then systemctl daemon-reload || did "systemd was not reloaded"; fi
    if running udevadm; then
        { udevadm control --reload && udevadm trigger --subsystem-match=tty --subsystem-match=usb-serial; } || did "udev was not reloaded"
    fi
}

if [ "$uninstall" = yes ]; then
    echo "scotopic: removing"
    if running systemctl; then systemctl disable --now scotopic.service 2>/dev/null || did "the service was not running"; fi
    for file in "$bin" "$unit" "$rules" "$rules.new" "$users" "$docs/installing.md" "$docs/settings.example.toml"; do
        if [ -e "$DESTDIR$file" ]; then
            rm -f "$DESTDIR$file"
            did "removed $file"
        fi
    done
    rmdir "$DESTDIR$docs" 2>/dev/null || true
    if [ "$purge" = yes ]; then
        for folder in /etc/scotopic /var/lib/scotopic; do
            if [ -d "$DESTDIR$folder" ]; then
                rm -rf -- "$DESTDIR$folder"
                did "removed $folder"
            fi
        done
        if running userdel && userdel scotopic 2>/dev/null; then did "removed the user scotopic"; fi
    else
        did "kept /etc/scotopic and /var/lib/scotopic (--purge removes them, and the user scotopic)"
    fi
    reload
    exit 0
fi

[ -f "$program" ] || wrong "$program is not there: cargo build --release first, or name it with --program FILE"

# put MODE SOURCE TARGET
put() {
    install -D -m "$1" -- "$2" "$DESTDIR$3"
    did "$3"
}

# What a person may have edited stays; the new one lies beside it.
keep() {
    if [ -e "$DESTDIR$3" ] && ! cmp -s -- "$2" "$DESTDIR$3"; then
        install -m "$1" -- "$2" "$DESTDIR$3.new"
        did "$3 is yours and stays; the new one is $3.new"
    else
        put "$1" "$2" "$3"
    fi
}

made=$(mktemp -d)
trap 'rm -rf -- "$made"' EXIT
sed "s|@PREFIX@|$PREFIX|g" "$here/scotopic.service" >"$made/unit"

# fill NAME VID:PID:SERIAL
fill() {
    [ -n "$2" ] || return 0
    vid=${2%%:*} rest=${2#*:}
    sed "s|${1}_VID|$vid|; s|${1}_PID|${rest%%:*}|; s|${1}_SERIAL|${rest#*:}|" "$made/rules" >"$made/filled"
    mv -- "$made/filled" "$made/rules"
}
cp -- "$here/70-scotopic.rules" "$made/rules"
fill MOUNT "$mount"
fill HANDBOX "$handbox"

echo "scotopic: installed${DESTDIR:+ in $DESTDIR}"
put 0755 "$program" "$bin"
put 0644 "$made/unit" "$unit"
put 0644 "$here/scotopic.sysusers" "$users"
if [ -n "$mount$handbox" ]; then
    put 0644 "$made/rules" "$rules"
else
    keep 0644 "$made/rules" "$rules"
fi
keep 0644 "$here/settings.toml" "$settings"
put 0644 "$here/../docs/installing.md" "$docs/installing.md"
put 0644 "$here/../docs/settings.example.toml" "$docs/settings.example.toml"

if running systemd-sysusers; then
    systemd-sysusers "$users" && did "the user scotopic, without a password, in a group of its own"
fi
reload
if running systemctl; then
    systemctl enable scotopic.service 2>/dev/null && did "the service starts with the computer"
fi

echo
echo "Left to you:"
step=1
todo() {
    echo "  $step. $1"
    step=$((step + 1))
}
if [ -z "$mount" ]; then
    todo "name the mount's adapter: udevadm info -q property -n /dev/ttyUSB0 | grep -E '^ID_(VENDOR_ID|MODEL_ID|SERIAL_SHORT)='"
    echo "     then run this again with --mount VID:PID:SERIAL (and --handbox ... for the hand controller), or edit $rules"
fi
todo "edit $settings: your site, the projector (every setting: $docs/settings.example.toml)"
todo "teach it the hand controller: sudo scotopic handbox learn --port /dev/scotopic-handbox --map /etc/scotopic/handbox.toml"
todo "try it in the foreground: scotopic observe --config $settings"
todo "sudo systemctl start scotopic; journalctl -fu scotopic"
echo "If your mount's firmware is patched so that '?' synchronises, bind another key: docs/hardware/hand-controller.md."
