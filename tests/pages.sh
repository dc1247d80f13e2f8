#!/bin/sh
# Compares the figures of studies/findings with the tables of the studies, or takes them from there:
#   sh tests/pages.sh check|fill [STUDY…]
# Studies whose results are not in $RICOCHET_PAGE_RESULTS (build/pages) are run; all of them take some twenty minutes.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
what=${1:?check or fill}
shift
cmake --build "$root/build/release" --target page_figures ricochet >/dev/null
"$root/build/release/bin/page_figures" "$what" "${RICOCHET_PAGE_RESULTS:-$root/build/pages}" "$@"
[ "$what" = check ] || python3 "$root/tests/studies_index.py"
