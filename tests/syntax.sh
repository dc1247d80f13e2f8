#!/bin/sh
# Reads by itself, and makes no code of, each source that changed since a commit (the one before HEAD): unity builds hide missing
# includes and shadowed names. With clang where it is installed.
set -eu
cd "$(dirname "$0")/.."
command -v git >/dev/null 2>&1 && git rev-parse -q --verify "${1:-HEAD~1}" >/dev/null 2>&1 || exit 0
most=60  # files: a few minutes
changed=$(git diff --name-only --diff-filter=d "${1:-HEAD~1}" -- 'core/*.cpp' 'runners/*.cpp' 'plugins/*.cpp' 'tests/*.cpp' |
  grep -v -E '^(plugins/examples|tests/benchmarks|tests/plugins/out_of_tree)/' | head -n $most)
[ -n "$changed" ] || exit 0
compiler=$(command -v clang++ || command -v c++)
cmake --preset syntax -DCMAKE_CXX_COMPILER="$compiler" -DRICOCHET_MPI=OFF -Wno-dev >/dev/null
known=$(ninja -C build/syntax -t targets all)
for file in $changed; do
  # By the name of its object; what is not built here (ranks without MPI) has none.
  printf '%s\n' "$known" | grep -E "^${file%%/*}/CMakeFiles/[^/]*\.dir/${file#*/}\.o:" | cut -d: -f1
done | xargs -P "$(nproc)" -I '{}' sh -c "cd build/syntax && ninja -t commands '{}' | tail -n 1 | sed 's/ -M[DTF] *[^ ]*\.o\(\.d\)*//g; s/ -MD / /' | sh"
