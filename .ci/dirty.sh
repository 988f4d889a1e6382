#!/bin/bash
# Promise: entry points called with the upper halves of the vector registers dirty take no longer than otherwise: dirty.sh [NAME].
set -euo pipefail
cd "$(dirname "$0")/.."
"$(.ci/release.sh)/entry" dirty "$@"
