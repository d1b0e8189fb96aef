#!/usr/bin/env bash
# The real kernel's display controller, in a virtual machine: KMS and framebuffer sinks of scotopic on QEMU's `bochs` display,
# and beside it the kernel's `vfb`, whose 8 bits a pixel must be refused. What the virtual screen shows is read back by QEMU and held against the picture
# that `scotopic projector pattern --out` writes, pixel by pixel; at the end the screen must be black.
#
# Wiring: none. Needs Linux on x86-64 and from apt: qemu-system-x86 busybox-static python3, and the package of a Debian kernel
# (found with `apt-get download`, or named: KERNEL_DEB=FILE). SCOTOPIC_KVM=1 makes it quicker where /dev/kvm works.
# Debian's kernel has no `vkms`; the bochs driver has the same dumb buffers and page flips, and a screen that can be read back.
#
#     cargo build --features kms && hil/kms.sh            # report: target/hil/kms/report.json
set -euo pipefail
cd "$(dirname "$0")/.."
program=${SCOTOPIC:-target/debug/scotopic}
work=target/hil/kms
rm -rf "$work" && mkdir -p "$work"

missing=()
for tool in qemu-system-x86_64 busybox python3 dpkg-deb; do command -v "$tool" >/dev/null || missing+=("$tool"); done
if [ ${#missing[@]} -gt 0 ] || [ ! -x "$program" ]; then
    [ -x "$program" ] || missing+=("$program (cargo build --features kms)")
    echo "not run: this needs ${missing[*]}" >&2
    exit 77
fi

# The kernel: its image and the modules of the bochs display, the virtual framebuffer and what they stand on.
if [ -z "${KERNEL_DEB:-}" ]; then
    name=$(apt-cache depends linux-image-amd64 | sed -n 's/.*Depends: \(linux-image-[0-9].*\)/\1/p' | head -1)
    (cd "$work" && apt-get download -q "$name" >/dev/null 2>&1)
    KERNEL_DEB=$(ls "$work"/linux-image-*.deb)
fi
dpkg-deb -x "$KERNEL_DEB" "$work/kernel"
image=$(ls "$work"/kernel/boot/vmlinuz-*)
python3 - "$work" <<'PY'
"""Copies modules with all that they depend on, in the order to load them."""
import pathlib, re, shutil, sys
work = pathlib.Path(sys.argv[1])
files = {p.stem.replace("-", "_"): p for p in (work / "kernel/lib/modules").rglob("*.ko")}
order = []
def load(name):
    if name in order or name not in files: return
    depends = re.search(rb"\0depends=([^\0]*)\0", b"\0" + files[name].read_bytes())
    for other in depends.group(1).decode().split(",") if depends else []: load(other.replace("-", "_"))
    order.append(name)
for name in ["bochs", "vfb"]: load(name)
root = work / "root"
(root / "modules").mkdir(parents=True)
for name in order: shutil.copy(files[name], root / "modules" / f"{name}.ko")
(root / "modules/order").write_text("\n".join(order) + "\n")
PY

# The guest: busybox, scotopic with the libraries it is linked to, and a script of what to do.
root=$work/root
mkdir -p "$root"/{bin,proc,sys,dev,tmp}
cp "$(command -v busybox)" "$root/bin/busybox"
cp "$program" "$root/bin/scotopic"
ldd "$program" | grep -o '/[^ ]*' | while read -r library; do
    mkdir -p "$root$(dirname "$library")" && cp -L "$library" "$root$library"
done
cat > "$root/init" <<'GUEST'
#!/bin/busybox sh
export PATH=/bin HOME=/tmp RUST_BACKTRACE=1
/bin/busybox --install -s /bin
mount -t proc none /proc; mount -t sysfs none /sys; mount -t devtmpfs none /dev
while read -r module; do
    case $module in vfb) set -- vfb_enable=1 ;; *) set -- ;; esac
    insmod /modules/$module.ko "$@" || echo "MARK no module $module"
done < /modules/order
sleep 1
echo "MARK outputs"; scotopic projector outputs
shown() { # shown NAME PATTERN PROJECTOR: shows it for twenty seconds; the host looks meanwhile
    scotopic projector pattern "$2" --projector "$3" --for 20 > /tmp/said 2>&1 &
    child=$!
    sleep 2; echo "MARK look $1"; cat /tmp/said; wait $child; echo "MARK end $1 $?"; sleep 1
}
connector=$(ls /sys/class/drm | sed -n 's/^card[0-9]*-\(Virtual.*\)/\1/p' | head -1)
# The kernel's framebuffer is read back from its device: without a console on it this machine's screen does not show it.
scotopic projector pattern finder --projector fb:/dev/fb0 --for 8 & sleep 4
echo "MARK framebuffer"; gzip -c < /dev/fb0 | base64; echo "MARK framebufferend"; wait
for pattern in grid orientation greys; do shown "kms-$pattern" $pattern "kms:$connector"; done
scotopic projector pattern orientation --projector fb:/dev/fb1 --for 1; echo "MARK eight $?"
echo "MARK refused"; scotopic projector pattern grid --projector kms:HDMI-A-9 --for 1
scotopic projector pattern ghost --projector "kms:$connector" --for 20 & sleep 2
scotopic projector pattern grid --projector "kms:$connector" --for 1; echo "MARK second $?"
# The worst end: nothing can be said, the kernel cleans up.
kill -9 $!; sleep 1; echo "MARK killed"; sleep 15
echo "MARK done"; poweroff -f
GUEST
chmod +x "$root/init"
(cd "$root" && find . | busybox cpio -o -H newc 2>/dev/null | gzip -1) > "$work/initramfs.gz"

# Emulated unless KVM is asked for: a virtual machine inside a virtual machine often does not start.
acceleration=(-accel tcg -cpu max)
[ -z "${SCOTOPIC_KVM:-}" ] || acceleration=(-enable-kvm -cpu host)
timeout 900 qemu-system-x86_64 "${acceleration[@]}" -m 768 -nodefaults -vga none -device bochs-display,xres=1280,yres=720 \
    -display none -serial "file:$work/serial.log" -monitor "unix:$work/monitor,server,nowait" -no-reboot \
    -kernel "$image" -initrd "$work/initramfs.gz" -append "console=ttyS0 quiet panic=-1 vt.global_cursor_default=0" &
qemu=$!
trap 'kill $qemu 2>/dev/null || true' EXIT

python3 - "$work" "$program" <<'PY'
"""Looks at the virtual screen whenever the guest says so, and holds it against what scotopic itself draws into a file."""
import base64, json, pathlib, socket, struct, subprocess, sys, time, zlib
work, program = pathlib.Path(sys.argv[1]), sys.argv[2]
serial, checks, seen = work / "serial.log", [], 0

def png(path):
    data, at, packed = path.read_bytes(), 8, b""
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        if kind == b"IHDR": width, height = struct.unpack(">II", data[at + 8:at + 16])
        if kind == b"IDAT": packed += data[at + 8:at + 8 + length]
        at += 12 + length
    raw, stride, rows, above = zlib.decompress(packed), width * 3, [], bytes(width * 3)
    for y in range(height):
        filter_, row = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        for i in range(stride):
            a, b, c = (row[i - 3] if i >= 3 else 0), above[i], (above[i - 3] if i >= 3 else 0)
            p = a + b - c
            paeth = min((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c))[2]
            row[i] = (row[i] + [0, a, b, (a + b) // 2, paeth][filter_]) & 255
        rows.append(bytes(row)); above = bytes(row)
    return width, height, b"".join(rows)

def ppm(path):
    data = path.read_bytes(); magic, size, depth, pixels = data.split(b"\n", 3)
    width, height = map(int, size.split()); return width, height, pixels

def look(name):
    path = work / f"{name}.ppm"
    with socket.socket(socket.AF_UNIX) as monitor:
        monitor.connect(str(work / "monitor")); monitor.settimeout(1)
        monitor.sendall(f"screendump {path}\n".encode()); time.sleep(0.7)
    return ppm(path)

drawn = {}
def expected(pattern, width, height):
    key = (pattern, width, height)
    if key not in drawn: drawn[key] = draw(*key)
    return drawn[key]

def draw(pattern, width, height):
    out = work / f"{pattern}-{width}x{height}.png"
    subprocess.run([program, "projector", "pattern", pattern, "--out", out, "--pixels", f"{width}x{height}"], check=True, stdout=subprocess.DEVNULL)
    return png(out)[2]

def check(name, passed, note): checks.append({"check": name, "passed": bool(passed), "note": note}); print(("pass " if passed else "FAIL ") + name + ": " + note)

def same(name, pattern, read):
    """Reads until it is what it should be, for some seconds: the virtual screen follows the guest with a delay."""
    until = time.time() + 8
    while True:
        width, height, pixels = read()
        want = expected(pattern, width, height)
        if pixels == want or time.time() > until: break
    wrong = sum(a != b for a, b in zip(pixels, want)) + abs(len(pixels) - len(want))
    check(name, wrong == 0, f"{width} x {height}, {wrong} of {len(want)} bytes differ")

for pattern in ["grid", "orientation", "greys", "finder", "ghost"]: expected(pattern, 1280, 720)
deadline = time.time() + 880
done = False
while not done and time.time() < deadline:
    time.sleep(0.1)
    text = serial.read_text(errors="replace") if serial.exists() else ""
    lines = text.splitlines(keepends=True)
    for line in [l.strip() for l in lines[seen:] if l.endswith("\n")]:
        seen += 1
        if line.startswith("MARK look "):
            name = line.split()[2]; same(name, name.split("-")[1], lambda: look(name))
        elif line.startswith("MARK end "):
            _, _, name, status = line.split()
            check(f"{name} ends with 0", status == "0", f"exit {status}")
        elif line.startswith("MARK second "):
            check("a second program is refused the display", line.split()[2] == "1", f"exit {line.split()[2]}")
        elif line == "MARK killed":
            width, height, pixels = look("killed")
            lit = sum(pixels[i] > 0 for i in range(0, len(pixels), 3)) / (width * height)
            check("after kill -9 the pattern is gone", lit < 0.2 and pixels != expected("ghost", width, height), f"{lit:.4f} of the screen lit (the kernel's console)")
        elif line == "MARK framebufferend":
            body = "".join(text.split("MARK framebuffer", 1)[1].split("MARK framebufferend")[0].split())
            held = zlib.decompress(base64.b64decode(body), 31)[:1280 * 720 * 4]
            rgb = b"".join(bytes((held[i + 2], held[i + 1], held[i])) for i in range(0, len(held), 4))
            same("framebuffer, read back from its device", "finder", lambda: (1280, 720, rgb))
        elif line.startswith("MARK eight "):
            check("a framebuffer of 8 bits is refused", line.split()[2] == "1", f"exit {line.split()[2]}")
        elif line == "MARK done":
            done = True
check("the guest came to its end", done, "MARK done")
report = {"suite": "kms in a virtual machine", "passed": all(c["passed"] for c in checks), "checks": checks}
(work / "report.json").write_text(json.dumps(report, indent=1) + "\n")
sys.exit(0 if report["passed"] else 1)
PY
