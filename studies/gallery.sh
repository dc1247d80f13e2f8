#!/bin/sh
# A site of studies: sh studies/gallery.sh [DIR] [--only NAME…]
# Runs each study that ships (or those named) into DIR/NAME, unless it is there and whole, and writes DIR/index.html.
# DIR: results/gallery where none is given. Run again, it goes on where it was stopped.
# Exit code: 0; 2 of a name that is none; 3 where a study has no page; 130 where it was interrupted.
set -u
here=$(cd "$(dirname "$0")" && pwd)
out=results/gallery
names=
given=no
while [ $# -gt 0 ]; do
  case $1 in
    --only) given=yes ;;
    -h | --help) sed -n '2,5s/^# //p' "$0"; exit 0 ;;
    -*) echo "gallery: there is no option $1; expected [DIR] [--only NAME…]" >&2; exit 2 ;;
    *) if [ $given = yes ]; then names="$names $1"; else out=$1; fi ;;
  esac
  shift
done
if [ $given = yes ] && [ -z "$names" ]; then echo "gallery: --only expects names of studies" >&2; exit 2; fi
if [ -z "$names" ]; then names=$(cd "$here" && ls ./*.json | sed 's,^\./,,; s,\.json$,,'); fi
for name in $names; do
  [ -f "$here/$name.json" ] || { echo "gallery: there is no study $here/$name.json" >&2; exit 2; }
done

program=${RICOCHET:-$here/../build/release/bin/ricochet}
[ -x "$program" ] || program=$(command -v ricochet) || { echo "gallery: found no ricochet; build it, or name it in RICOCHET" >&2; exit 4; }
mkdir -p "$out" || exit 5

bare=
for name in $names; do
  # What ended is marked, so that a stopped run is not taken for one.
  if [ "$out/$name/.ended" -nt "$here/$name.json" ] && [ -f "$out/$name/report.html" ]; then continue; fi
  echo "gallery: $name"
  rm -f "$out/$name/.ended"
  "$program" run "$here/$name.json" --out "$out/$name" >"$out/$name.log" 2>&1
  code=$?
  case $code in
    0 | 3 | 6) touch "$out/$name/.ended" && rm -f "$out/$name.log" ;;
    130) echo "gallery: interrupted; the same command again goes on" >&2; exit 130 ;;
    *) echo "gallery: $name ended with $code: $(tail -n 1 "$out/$name.log")" >&2; bare="$bare $name" ;;
  esac
done
python3 "$here/gallery.py" "$out" || exit $?
[ -z "$bare" ] || { echo "gallery: without a page:$bare" >&2; exit 3; }
