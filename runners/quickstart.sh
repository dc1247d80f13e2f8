#!/bin/sh
# From a bare Debian 12 (root or sudo) to a first report: installs what is missing, builds, runs a study, says where its report is.
# May be run again at any time; a second run needs no network.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/runners/packages.sh"
cd "$root"

say "Ricochet: installs what is missing of compiler, CMake and libraries from Debian (named below), builds into build/release,"
say "runs one study into results. Two cores take some five minutes and 600 MB the first time, a second run seconds."
# shellcheck disable=SC2086  # lists of words
install_missing $build_commands $build_packages

say "Building"
cmake --preset release -DRICOCHET_TESTS=OFF -Wno-dev
cmake --build --preset release --target ricochet

study=studies/energy-undamped.json
report=results/energy-undamped/report.html
say "Running $study"
status=0
build/release/bin/ricochet run "$study" || status=$?
# 3: some cases failed, and the report says which.
[ "$status" -eq 0 ] || [ "$status" -eq 3 ] || exit "$status"
[ -s "$report" ] || give_up "the run ended without a report"
say ""
say "The report: $root/$report  (open it in a browser; it needs no network)"
say "Next: edit studies/quick.json and run  build/release/bin/ricochet run studies/quick.json"
