# Sourced by runners/quickstart.sh and tests/run.sh, which set `root` to the project's folder: what this project needs of Debian 12,
# fetched only when it is missing, so that a second run needs no network.

say() { printf '%s\n' "$*"; }
give_up() { printf 'error: %s\n' "$*" >&2; exit 1; }

# Beyond the standard library: matrices (Eigen, CHOLMOD of SuiteSparse, headers of Boost), words of commands (Boost), JSON, formulas
# (muParser), the store (SQLite), texts (fmt), modes of large structures (Spectra), pages (mustache), messages between processes (cereal),
# results in one file (libarchive).
build_packages="libeigen3-dev libsuitesparse-dev libboost-dev libboost-program-options-dev nlohmann-json3-dev
libmuparser-dev libsqlite3-dev libsqlitecpp-dev libfmt-dev libkainjow-mustache-dev
libcereal-dev libspectra-dev libarchive-dev"
# command=package: the command may come from elsewhere than Debian.
build_commands="g++=g++ cmake=cmake ninja=ninja-build"

installed() { [ "$(dpkg-query -W -f='${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then
    "$@"
  elif command -v sudo >/dev/null 2>&1; then
    sudo "$@"
  else
    give_up "this needs root or sudo: $*"
  fi
}

# install_missing PACKAGE|COMMAND=PACKAGE …
install_missing() {
  missing=""
  for item in "$@"; do
    package=${item#*=}
    case $item in
      *=*) command -v "${item%%=*}" >/dev/null 2>&1 || missing="$missing $package" ;;
      *) installed "$package" || missing="$missing $package" ;;
    esac
  done
  [ -z "$missing" ] && return 0
  command -v apt-get >/dev/null 2>&1 || give_up "this is written for Debian 12; elsewhere install what matches:$missing"
  say "Installing:$missing"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -q || say "apt-get update failed; trying with the lists that are there" >&2
  # shellcheck disable=SC2086  # a list of words
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -q --no-install-recommends $missing ||
    give_up "apt-get could not install:$missing"
}
