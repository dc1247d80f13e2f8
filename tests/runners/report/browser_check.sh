#!/bin/sh
# browser_check.sh REPORT.html FOLDER CHARTS
# Opens a report in headless Chromium and fails unless the page itself says that every one of its CHARTS charts is drawn in every view, that
# its zoom is linked, its legend filters, its pictures export, its table sorts and filters, and nothing was reported to the console.
# Leaves dom.html, console.txt and page.png in FOLDER. Exit codes: 0 fine, 1 not fine, 127 no browser.
set -u
report=$1 folder=$2 charts=$3

browser=${RICOCHET_BROWSER:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
if [ -z "$browser" ]; then
  echo "no browser: install chromium (tests/run.sh does), or set RICOCHET_WITHOUT_BROWSER=1 to leave this check out" >&2
  exit 127
fi
mkdir -p "$folder"
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT

# Home and caches in the new folder too: the check must not depend on, or touch, the user's.
HOME=$profile XDG_CONFIG_HOME=$profile XDG_CACHE_HOME=$profile timeout 300 "$browser" --headless --no-sandbox --disable-gpu \
  --disable-quic --disable-dev-shm-usage --no-first-run --disable-background-networking --disable-component-update --disable-sync \
  --disable-extensions --user-data-dir="$profile" --window-size=1300,1800 --hide-scrollbars --virtual-time-budget=30000 \
  --enable-logging=stderr --v=0 --screenshot="$folder/page.png" --dump-dom "file://$report#selfcheck" \
  >"$folder/dom.html" 2>"$folder/console.txt" || { echo "the browser did not end well: $folder/console.txt" >&2; exit 1; }

failed=0
fail() { echo "$1" >&2; failed=1; }

if grep -q 'CONSOLE' "$folder/console.txt"; then
  fail "the console is not empty:"
  grep 'CONSOLE' "$folder/console.txt" >&2
fi

# The page's own words, as JSON on one line.
grep -o 'data-selfcheck="[^"]*"' "$folder/dom.html" | head -n 1 | sed -e 's/^data-selfcheck="//' -e 's/"$//' -e 's/&quot;/"/g' \
  -e 's/&lt;/</g' -e 's/&gt;/>/g' -e 's/&amp;/\&/g' >"$folder/selfcheck.json"
[ -s "$folder/selfcheck.json" ] || { fail "the page did not check itself"; exit 1; }
grep -q '"errors":\[\]' "$folder/selfcheck.json" || fail "the page met errors"

drawn=$(grep -o '<canvas' "$folder/dom.html" | wc -l)
[ "$drawn" -ge "$charts" ] || fail "$drawn of $charts charts have a canvas"
exit $failed
