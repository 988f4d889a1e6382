#!/bin/bash
# Promise: the AVX-512 level is tested on any machine. Where the CPU has no AVX-512, the tests run in Bochs, which emulates
# one (valgrind and QEMU do not): otherwise users would be the first to run this level.
#
#   .ci/avx512.sh           in Bochs, unless this CPU has AVX-512
#   .ci/avx512.sh --bochs   in Bochs in any case
#
# A Linux kernel boots there with the programs alone, at some 50 million instructions per second. It runs the tests that
# iterate over levels: slices against packets, packets of this level against AVX2's and against one lane. It compares the
# answers of every entry point with the paper's formulas in f64, as the benches do. At the end one test must fail on a copy
# without 512-bit square roots. All that takes 100 s of CPU time, after the build. Needs the Rust toolchain, python3, and
# Debian's packages, of which only Bochs and xorriso are installed.
set -euo pipefail
cd "$(dirname "$0")/.."
. .ci/flags
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
dir=$(mktemp -d)
trap 'rm -rf "$dir"' EXIT

# The programs.
mkdir -p "$dir/files/tests"
cargo build -q --release --locked --target-dir "$target" -p hairis-benches --bin entry
cp "$target/release/entry" "$dir/files/tests/"
cargo test -q --release --locked --target-dir "$target" -p hairis -p hairis-variants --all-features \
  --test main --test samplers --no-run --message-format=json > "$dir/built"
python3 - "$dir" <<'END'
import json, re, shutil, sys
tests = f"{sys.argv[1]}/files/tests"
for line in open(f"{sys.argv[1]}/built"):
    built = json.loads(line)
    if built.get("executable"):
        name = f"{built['manifest_path'].split('/')[-2]}-{built['target']['name']}"
        if name != "kernels-samplers":
            shutil.copy(built["executable"], f"{tests}/{name}")
# vsqrtps of 512-bit registers becomes vmovaps.
code, roots = re.subn(rb"(\x62.\x7c\x48)\x51", lambda m: m[1] + b"\x28", open(f"{tests}/kernels-main", "rb").read(), flags=re.S)
assert roots, "no square root of 512 bits in the kernels' tests"
open(f"{tests}/broken", "wb").write(code)
END
strip "$dir"/files/tests/*
chmod +x "$dir"/files/tests/*

# The tests, run here or in Bochs.
cat > "$dir/files/tests/all" <<'END'
cd "$(dirname "$0")"
fail() { cat out; echo "FAIL: $*"; exit 1; }
./entry list > out && grep '/avx512$' out > entries || fail "the level found here is not AVX-512"
for test in kernels-main variants-main variants-samplers; do
  echo "$test"
  HAIRIS_CASES=1 ./$test --test-threads 1 --include-ignored slices_equal_packets levels_agree parity::levels lambert_fiber:: > out 2>&1 || fail "$test"
  grep -v '^$' out
  grep -qE 'test result: ok\. ([7-9]|[1-9][0-9]+) passed' out || fail "$test: too few tests ran"
done
for entry in $(cat entries); do
  ./entry run "$entry" 1 > out 2>&1 || fail "$entry"
done
echo "$(wc -l < entries) entry points of AVX-512 give the reference's answers"
./broken hair::slices_equal_packets > out 2>&1 && fail "slices without square roots passed"
grep -q 'entry .* on avx512' out || fail "slices without square roots failed, but not on AVX-512"
echo "without square roots a test fails, as it must: $(grep -o 'entry .* on avx512.*' out | head -1)"
echo "the AVX-512 level passed"
END

has() { grep -qw "$1" /proc/cpuinfo; }
if [ "${1:-}" != --bochs ] && has avx512f && has avx512vl && has avx512dq && has avx512bw; then
  echo "this CPU has AVX-512: no emulation"
  sh "$dir/files/tests/all"
  exit
fi

# Packages.
.ci/apt update -qq
.ci/apt install -qqy bochs bochs-term xorriso bsdutils > /dev/null
kernel=$(apt-cache depends linux-image-cloud-amd64 | sed -n 's/.*Depends: \(linux-image-[0-9].*\)/\1/p' | head -1)
mkdir "$dir/debs"
chmod 755 "$dir"
chmod 777 "$dir/debs"
(cd "$dir/debs" && apt-get download -qq "$kernel" busybox-static isolinux syslinux-common)
for deb in "$dir"/debs/*.deb; do dpkg -x "$deb" "$dir/packages"; done

# The disc: a boot loader, the kernel and its first files.
mkdir -p "$dir/files/bin" "$dir/files/proc" "$dir/disc/isolinux"
busybox=$dir/packages/bin/busybox
cp "$busybox" "$dir/files/bin/"
ldd "$dir"/files/tests/{entry,*-main,*-samplers} | grep -oE '/[^ :]+\.so[^ :]*' | sort -u | xargs cp -L --parents -t "$dir/files"
cat > "$dir/files/init" <<'END'
#!/bin/busybox sh
/bin/busybox --install /bin
mount -t proc none /proc
grep -m1 'model name' /proc/cpuinfo
sh /tests/all
stty echo # waits until the last line is out
poweroff -f
END
chmod +x "$dir/files/init"
(cd "$dir/files" && find . | "$busybox" cpio -o -H newc 2> /dev/null) > "$dir/disc/initrd"
cp "$dir"/packages/boot/vmlinuz-* "$dir/disc/vmlinuz"
cp "$dir"/packages/usr/lib/{ISOLINUX/isolinux.bin,syslinux/modules/bios/ldlinux.c32} "$dir/disc/isolinux/"
# Bochs 2.7 misstates the size of what XSAVEC and XSAVES write, on which Linux does without AVX: it is to use XSAVE. The
# self-tests of Linux's ciphers would take half of the time to boot.
cat > "$dir/disc/isolinux/isolinux.cfg" <<'END'
DEFAULT linux
LABEL linux
  KERNEL /vmlinuz
  INITRD /initrd
  APPEND console=ttyS0 quiet loglevel=0 nokaslr mitigations=off tsc=reliable clearcpuid=xsavec,xsaves cryptomgr.notests
END
xorriso -as mkisofs -quiet -o "$dir/disc.iso" -b isolinux/isolinux.bin -c isolinux/boot.cat -no-emul-boot \
  -boot-load-size 4 -boot-info-table "$dir/disc" > "$dir/xorriso" 2>&1 || { cat "$dir/xorriso"; exit 1; }

# The machine. Power off ends Bochs, which reports it as a panic. Debian's Bochs has a debugger, which waits for "c".
cat > "$dir/bochsrc" <<END
config_interface: textconfig
display_library: term
megs: 512
romimage: file=/usr/share/bochs/BIOS-bochs-latest
vgaromimage: file=/usr/share/bochs/VGABIOS-lgpl-latest
cpu: model=corei7_skylake_x, ips=50000000
clock: sync=none
ata0-master: type=cdrom, path=$dir/disc.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=$dir/serial
log: $dir/log
panic: action=fatal
error: action=report
END
echo c > "$dir/commands"
start=$SECONDS
# Bochs needs a terminal for its screen.
TERM=vt100 script -qec "timeout -s KILL 1200 bochs-bin -q -f '$dir/bochsrc' -rc '$dir/commands'" /dev/null \
  < /dev/null > "$dir/screen" 2>&1 || true
touch "$dir/serial"
cat "$dir/serial"
grep -q '^the AVX-512 level passed' "$dir/serial" || { echo "FAIL: it did not pass in Bochs, which ended so:"; grep PANIC "$dir/log"; exit 1; }
echo "took $((SECONDS - start))s in Bochs"
