#!/bin/sh
# Keeps the smallest inputs of fuzz/corpus/TARGET that together cover what all of it covers, 100 at most:
# fuzz/keep.sh TARGET -> fixtures/fuzz/TARGET.hex, one input a line. Lines that begin with "!" were findings: they stay.
set -eu
cd "$(dirname -- "$0")"
target=${1:?which target? $(ls fuzz_targets)}
small=$(mktemp -d)
trap 'rm -rf -- "$small"' EXIT
cargo +nightly fuzz run "$target" "$small" -- -set_cover_merge=1 "corpus/$target" 2>"$small.log" || { tail "$small.log"; exit 1; }
rm -f -- "$small.log"
kept=../fixtures/fuzz/$target.hex
{
    if [ -f "$kept" ]; then grep '^!' "$kept" || true; fi
    find "$small" -type f -size +0 -printf '%s %p\n' | sort -n | head -100 | cut -d' ' -f2- | while read -r input; do
        od -An -v -tx1 -- "$input" | tr -d ' \n'
        echo
    done
} >"$small/kept"
mv -- "$small/kept" "$kept"
wc -lc "$kept"
