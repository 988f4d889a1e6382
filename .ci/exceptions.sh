#!/bin/bash
# Promise: calls on one lane raise no floating-point exception where they are compiled as a host compiles them. The tests,
# which have the same promise for eight lanes, are compiled without the pass that could break it.
set -euo pipefail
cd "$(dirname "$0")/.."
"$(.ci/release.sh)/entry" exceptions
echo "calls on one lane: no exceptions"
