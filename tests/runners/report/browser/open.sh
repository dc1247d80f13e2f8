#!/bin/sh
# open.sh PAGE.html FOLDER
# Opens a page in headless Chromium and fails unless it ends well with nothing reported to the console.
# Leaves dom.html, console.txt and page.png in FOLDER. Exit codes: 0 fine, 1 not fine, 127 no browser.
set -u
page=$1 folder=$2

browser=${RICOCHET_BROWSER:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
if [ -z "$browser" ]; then
  echo "no browser: install chromium (tests/run.sh does), or set RICOCHET_WITHOUT_BROWSER=1 to leave this check out" >&2
  exit 127
fi
mkdir -p "$folder"
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT

# Home and caches in the new folder too: the check must not depend on, or touch, the user's.
HOME=$profile XDG_CONFIG_HOME=$profile XDG_CACHE_HOME=$profile timeout 500 "$browser" --headless --no-sandbox --disable-gpu \
  --disable-quic --disable-dev-shm-usage --no-first-run --disable-background-networking --disable-component-update --disable-sync \
  --disable-extensions --user-data-dir="$profile" --window-size=1300,1800 --hide-scrollbars --virtual-time-budget=30000 \
  --enable-logging=stderr --v=0 --screenshot="$folder/page.png" --dump-dom "file://$page" \
  >"$folder/dom.html" 2>"$folder/console.txt" || { echo "the browser did not end well: $folder/console.txt" >&2; exit 1; }

if grep -q 'CONSOLE' "$folder/console.txt"; then
  echo "the console is not empty:" >&2
  grep 'CONSOLE' "$folder/console.txt" >&2
  exit 1
fi
