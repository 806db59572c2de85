#!/usr/bin/env bash
# Re-renders golden images: the only way to change them. State why in the commit.
set -euo pipefail

usage() {
    cat <<'TEXT'
Usage: tests/golden/update.sh [SCENE [ID]]
  without arguments  every image that there is
  SCENE              the images of one scene, a folder of tests/golden
  SCENE ID           one image; a technique's first one is made this way
Build first: scons. Look at each image before you commit it.
TEXT
}

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
if [ $# -gt 2 ] || [[ "${1:-}" == -* ]]; then
    usage
    [[ "${1:-}" == -h || "${1:-}" == --help ]] && exit 0
    exit 2
fi
requested=${1:-all}
if [ $# -ge 1 ] && [ ! -f "tests/golden/$1/golden.json" ]; then
    echo "ERROR: tests/golden/$1/golden.json is missing. Scenes: $(cd tests/golden && echo */)" >&2
    exit 1
fi
[ $# -eq 2 ] && requested=$1/$2
if [ ! -x bin/gnomon_tests ]; then
    echo "ERROR: bin/gnomon_tests is missing. Run scons first." >&2
    exit 1
fi
GNOMON_UPDATE_GOLDEN=$requested bin/gnomon_tests '--test-case=[GPU][Golden] every image*'
git status --short -- tests/golden
