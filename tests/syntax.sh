#!/bin/sh
# Reads sources by themselves, and makes no code of them: unity builds hide missing includes and shadowed names. Those that changed since
# the commit at which all were read, or since another one; or all. With clang where it is installed.
#     sh tests/syntax.sh [COMMIT | all [words for cmake]]
set -eu
cd "$(dirname "$0")/.."
all_read=7a373d7e  # clang 14 had read by then, file by file, the whole tree, and what changed later
since=${1:-$all_read}
[ $# -eq 0 ] || shift
if [ "$since" != all ] && ! git rev-parse -q --verify "$since^{commit}" >/dev/null 2>&1; then
  echo "there is no commit $since here: the sources of the last commit alone are read by themselves" >&2
  since=HEAD~1
  git rev-parse -q --verify "$since" >/dev/null 2>&1 || exit 0
fi
if [ "$since" = all ]; then
  files=$(git ls-files -- 'core/*.cpp' 'runners/*.cpp' 'plugins/*.cpp' 'tests/*.cpp')
else
  files=$(git diff --name-only --diff-filter=d "$since" -- 'core/*.cpp' 'runners/*.cpp' 'plugins/*.cpp' 'tests/*.cpp')
fi
files=$(printf '%s\n' "$files" | grep -v -E '^(plugins/examples|tests/benchmarks|tests/plugins/out_of_tree)/' || true)
[ -n "$files" ] || exit 0
echo "Reading $(printf '%s\n' "$files" | wc -l) sources by themselves"
compiler=$(command -v clang++ || command -v c++)
cmake --preset syntax -DCMAKE_CXX_COMPILER="$compiler" -DRICOCHET_MPI=OFF -Wno-dev "$@" >/dev/null
known=$(ninja -C build/syntax -t targets all)
for file in $files; do
  # By the name of its object; what is not built here (ranks without MPI) has none.
  printf '%s\n' "$known" | grep -E "^${file%%/*}/CMakeFiles/[^/]*\.dir/${file#*/}\.o:" | cut -d: -f1
done | xargs -P "$(nproc)" -I '{}' sh -c "cd build/syntax && ninja -t commands '{}' | tail -n 1 | sed 's/ -M[DTF] *[^ ]*\.o\(\.d\)*//g; s/ -MD / /' | sh"
