#!/bin/sh
# Installs what the tests need, builds everything, runs the whole suite. Exit code and closing lines are those of ctest.
# May be run again at any time; a second run needs no network.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/runners/packages.sh"
cd "$root"

# shellcheck disable=SC2086  # lists of words
install_missing $build_commands $build_packages catch2
# The report is looked at in a browser; RICOCHET_WITHOUT_BROWSER=1 says that this machine shall go without.
[ "${RICOCHET_WITHOUT_BROWSER:-}" = 1 ] || install_missing chromium=chromium node=nodejs pdftotext=poppler-utils
fetch_charts

cmake --preset release -DRICOCHET_TESTS=ON
cmake --build --preset release
exec ctest --preset release -j "$(nproc)"
