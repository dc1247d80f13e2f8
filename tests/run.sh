#!/bin/sh
# Installs what the tests need, builds all of it, runs the whole suite. Exit code and closing lines are those of ctest.
# May be run again at any time; a second run needs no network. Words behind it go to cmake.
set -eu
root=$(cd "$(dirname "$0")/.." && pwd)
. "$root/runners/packages.sh"
cd "$root"

# shellcheck disable=SC2086  # lists of words
install_missing $build_commands $build_packages catch2 git=git python3=python3
# The report is looked at in a browser; RICOCHET_WITHOUT_BROWSER=1 says that this machine shall go without.
[ "${RICOCHET_WITHOUT_BROWSER:-}" = 1 ] || install_missing chromium=chromium node=nodejs pdftotext=poppler-utils
# Runs on several machines are tried with Open MPI and with Slurm, both on this one; RICOCHET_WITHOUT_MPI=1: neither.
mpi=ON
if [ "${RICOCHET_WITHOUT_MPI:-}" = 1 ]; then
  mpi=OFF
else
  install_missing openmpi-bin libopenmpi-dev slurmctld slurmd slurm-client munge
fi
# Editors read the schema by ajv, and so does the suite: what the lock file of its folder pins.
install_missing node=nodejs
validator=$root/tests/runners/study/validator
if [ ! -d "$validator/node_modules/ajv" ]; then
  command -v npm >/dev/null 2>&1 || install_missing npm=npm
  say "Fetching ajv (once)"
  (cd "$validator" && npm ci --no-audit --no-fund) || give_up "npm could not fetch ajv, which the tests of the schema need"
fi

# A compiler cache, where there is one, finds again what did not change, in another folder, too.
if command -v ccache >/dev/null 2>&1; then
  set -- "-DCMAKE_CXX_COMPILER_LAUNCHER=env;CCACHE_BASEDIR=$root;CCACHE_NOHASHDIR=1;CCACHE_SLOPPINESS=pch_defines,time_macros;ccache" "$@"
fi
cmake --preset release -DRICOCHET_TESTS=ON -DRICOCHET_MPI=$mpi "$@"
cmake --build --preset release --target tests
# Another compiler knows other warnings.
sh tests/syntax.sh "" -DCMAKE_COMPILE_WARNING_AS_ERROR=OFF "$@"
# Tests of processes and of the browser wait for much of their time.
exec ctest --preset release -j "$(($(nproc) + 2))"
