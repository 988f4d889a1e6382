#!/bin/bash
# Promise: calls raise no floating-point exception on everyday input where they are compiled as a Rust host compiles them. The tests,
# which have the same promise, are compiled without the pass that could break it. .ci/hosts.sh checks the C library and the wheel, and
# .ci/shaders.sh generated C.
set -euo pipefail
cd "$(dirname "$0")/.."
printf 'Rust in a release build: '
"$(.ci/release.sh)/entry" exceptions
