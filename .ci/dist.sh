#!/bin/bash
# Puts everything that a release consists of into one folder: dist.sh [DIR], by default target/dist. Archives of the Rust packages, the C
# library with its headers, the wheel, manual pages and shell completions, the generated shaders and the page for browsers, with a list of contents and checksums. Needs
# what .ci/package.sh, .ci/hosts.sh and .ci/page.sh need.
set -euo pipefail
cd "$(dirname "$0")/.."
target=$(realpath -m "${CARGO_TARGET_DIR:-target}")
to=$(realpath -m "${1:-$target/dist}")
[ ! -e "$to" ] || [ -f "$to/SHA256SUMS" ] || { echo "$to must be new or an earlier release, got another folder" >&2; exit 2; }
git diff --quiet HEAD || { echo "the tree must be that of a commit, got changes: git status" >&2; exit 2; }
version=$(sed -n 's/^version = "\(.*\)"/\1/p' Cargo.toml | head -1)
stage=$(mktemp -d)
trap 'rm -rf "$stage"' EXIT
# What goes into the folder when all of it is there.
dir=$stage/dist
mkdir -p "$dir/crates"
quietly() { "$@" > "$stage/log" 2>&1 || { cat "$stage/log" >&2; return 1; }; }
# An archive of the folder $stage/NAME: the same bytes for the same contents.
pack() { # pack NAME
  cp LICENSE-* "$stage/$1"
  tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@${SOURCE_DATE_EPOCH:-$(git log -1 --format=%ct)}" -C "$stage" -c "$1" |
    gzip -n > "$dir/$1.tar.gz"
}

.ci/package.sh
cp "$target"/package/*.crate "$dir/crates"

c=hairis-c-$version-$(uname -m)-linux
DESTDIR=$stage/$c quietly variants/capi/install.sh /
# Found beside itself, wherever the archive is unpacked.
sed -i 's|^prefix=.*|prefix=${pcfiledir}/../..|' "$stage/$c/lib/pkgconfig/hairis.pc"
# The examples that need the library alone.
mkdir "$stage/$c/examples"
cp -r variants/capi/examples/*.c variants/capi/examples/*.cpp variants/capi/examples/mitsuba "$stage/$c/examples"
pack "$c"

python=$target/hosts/venv/bin
[ -x "$python/pip" ] || python3 -m venv "$target/hosts/venv"
"$python/pip" install -q 'maturin[zig]>=1.9,<2'
# For distributions from 2014 on: Zig links against the C library of that year. maturin calls the Python that it finds first for it.
(cd variants/python && PATH=$python:$PATH maturin build -q --locked --zig --compatibility manylinux2014 \
  --target-dir "$target/hosts/manylinux" --out "$dir")

manual=hairis-manual-$version
quietly cargo run -q --release --locked -p hairis-manual -- "$stage/$manual"
pack "$manual"

shaders=hairis-shaders-$version
HAIRIS=$(.ci/release.sh)/hairis
quietly "$HAIRIS" shader --out "$stage/$shaders"
pack "$shaders"

# One quick test in the browser: the page is built as there.
HAIRIS=$HAIRIS quietly .ci/page.sh times
cp -r "$target/page" "$stage/hairis-page-$version"
pack "hairis-page-$version"

commit=$(git rev-parse --short HEAD)
cd "$dir"
{
  echo "hairis $version, commit $commit"
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
rm -rf "$to"
mkdir -p "$(dirname "$to")"
mv "$dir" "$to"
echo "$to has what CONTENTS lists, with checksums in SHA256SUMS"
