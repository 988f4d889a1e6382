#!/bin/bash
# Puts everything that a release consists of into one folder: dist.sh [DIR], by default target/dist. Archives of the Rust packages, the C
# library with its headers, the wheel, the generated shaders and the page for browsers, with a list of contents and checksums. Needs
# what .ci/package.sh, .ci/hosts.sh and .ci/page.sh need.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
dir=$(realpath -m "${1:-$target/dist}")
[ ! -e "$dir" ] || [ -f "$dir/SHA256SUMS" ] || { echo "$dir must be new or an earlier release, got another folder" >&2; exit 2; }
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
rm -rf "$dir"
mkdir -p "$dir/crates"
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
# An archive of the folder $stage/NAME: the same bytes for the same contents.
pack() { # pack NAME
  cp LICENSE-* "$stage/$1"
  tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}" -C "$stage" -c "$1" |
    gzip -n > "$dir/$1.tar.gz"
}

.ci/package.sh
cp "$target"/package/*.crate "$dir/crates"

c=hairis-c-$version-$(uname -m)-linux
DESTDIR=$stage/$c variants/capi/install.sh / > /dev/null
# Found beside itself, wherever the archive is unpacked.
sed -i 's|^prefix=.*|prefix=${pcfiledir}/../..|' "$stage/$c/lib/pkgconfig/hairis.pc"
cp -r variants/capi/examples variants/capi/docs variants/capi/README.md "$stage/$c"
pack "$c"

python=$target/hosts/venv/bin
[ -x "$python/maturin" ] || { python3 -m venv "$target/hosts/venv" && "$python/pip" install -q 'maturin>=1.9,<2'; }
(cd variants/python && "$python/maturin" build -q --locked --target-dir "$target/hosts/wheel" --out "$dir")

shaders=hairis-shaders-$version
HAIRIS=$(.ci/release.sh)/hairis
"$HAIRIS" shader --out "$stage/$shaders" > /dev/null
pack "$shaders"

# One quick test in the browser: the page is built as there.
HAIRIS=$HAIRIS .ci/page.sh times > /dev/null
cp -r "$target/page" "$stage/hairis-page-$version"
pack "hairis-page-$version"

cd "$dir"
{
  echo "hairis $version, commit $(git -C "$OLDPWD" rev-parse --short HEAD)"
  find . -type f ! -name CONTENTS -printf '%P\n' | LC_ALL=C sort | while read -r file; do
    printf '\n%s, %s bytes\n' "$file" "$(stat -c %s "$file")"
    case $file in
      *.tar.gz | *.crate) tar tzf "$file" | grep -v '/$' | sed 's/^/  /' ;;
      *.whl) python3 -m zipfile -l "$file" | awk 'NR > 1 {print "  " $1}' ;;
    esac
  done
} > CONTENTS
find . -type f ! -name SHA256SUMS -printf '%P\n' | LC_ALL=C sort | xargs sha256sum > SHA256SUMS
sha256sum -c --quiet SHA256SUMS
grep ' bytes$' CONTENTS
echo "$dir has $(wc -l < SHA256SUMS) files, which CONTENTS lists"
