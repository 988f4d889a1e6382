#!/bin/bash
# Promise: the workflow, the issue forms and CITATION.cff follow their schemas, and the workflow runs the jobs of .ci/run.
set -euo pipefail
cd "$(dirname "$0")/.."
tools=$(realpath -m "${CARGO_TARGET_DIR:-target}")/tools/schemas
[ -x "$tools/bin/check-jsonschema" ] || { python3 -m venv "$tools" && "$tools/bin/pip" install -q check-jsonschema==0.39.0; }
check() { "$tools/bin/check-jsonschema" --builtin-schema "vendor.$1" "${@:2}"; }
check github-workflows .github/workflows/*.yml
check github-issue-config .github/ISSUE_TEMPLATE/config.yml
for form in .github/ISSUE_TEMPLATE/*.yml; do [[ $form == */config.yml ]] || check github-issue-forms "$form"; done
check citation-file-format CITATION.cff
jobs() { sed -nE "s/^ *($1)[(\[](.*)[])]\$/\2/p" "$2" | tr -d ,; }
[ "$(jobs 'jobs=' .ci/run)" = "$(jobs 'job: ' .github/workflows/ci.yml)" ] ||
  { echo "FAIL: the workflow's jobs are not those of .ci/run"; exit 1; }
