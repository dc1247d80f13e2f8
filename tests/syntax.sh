#!/bin/sh
# Reads by itself, and makes no code of, each source that changed since a commit (the one before HEAD): unity builds hide missing
# includes and shadowed names. With clang where it is installed.
set -eu
cd "$(dirname "$0")/.."
since=${1:-HEAD~1}
if ! git rev-parse -q --verify "$since" >/dev/null 2>&1; then
  echo "no source is read by itself: there is no commit $since here" >&2
  exit 0
fi
most=60  # files: a few minutes
all=$(git diff --name-only --diff-filter=d "$since" -- 'core/*.cpp' 'runners/*.cpp' 'plugins/*.cpp' 'tests/*.cpp' |
  grep -v -E '^(plugins/examples|tests/benchmarks|tests/plugins/out_of_tree)/' || true)
[ -n "$all" ] || exit 0
changed=$(printf '%s\n' "$all" | head -n $most)
echo "Reading $(printf '%s\n' "$changed" | wc -l) of $(printf '%s\n' "$all" | wc -l) changed sources by themselves"
compiler=$(command -v clang++ || command -v c++)
cmake --preset syntax -DCMAKE_CXX_COMPILER="$compiler" -DRICOCHET_MPI=OFF -Wno-dev >/dev/null
known=$(ninja -C build/syntax -t targets all)
for file in $changed; do
  # By the name of its object; what is not built here (ranks without MPI) has none.
  printf '%s\n' "$known" | grep -E "^${file%%/*}/CMakeFiles/[^/]*\.dir/${file#*/}\.o:" | cut -d: -f1
done | xargs -P "$(nproc)" -I '{}' sh -c "cd build/syntax && ninja -t commands '{}' | tail -n 1 | sed 's/ -M[DTF] *[^ ]*\.o\(\.d\)*//g; s/ -MD / /' | sh"
