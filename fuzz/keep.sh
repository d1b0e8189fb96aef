#!/bin/sh
# Keeps inputs of fuzz/corpus/TARGET that each cover something of their own, 100 and 11 kB at most, taken in the order of
# their names, which are hashes: a fair sample.
# fuzz/keep.sh TARGET -> fixtures/fuzz/TARGET.hex, one input a line. Lines that begin with "!" were findings: they stay.
set -eu
cd "$(dirname -- "$0")"
target=${1:?which target? $(ls fuzz_targets)}
small=$(mktemp -d)
trap 'rm -rf -- "$small"' EXIT
# cargo-fuzz puts its own folder last, and libFuzzer merges into the first.
cargo +nightly fuzz run "$target" "corpus/$target" -- -merge=1 "$small" 2>"$small.log" || { tail "$small.log"; exit 1; }
rm -f -- "$small.log"
kept=../fixtures/fuzz/$target.hex
{
    if [ -f "$kept" ]; then grep '^!' "$kept" || true; fi
    find "$small" -type f -size +0 -printf '%p %s\n' | sort | awk '{ sum += $2; if (NR <= 100 && sum <= 11000) print $1 }' | while read -r input; do
        od -An -v -tx1 -- "$input" | tr -d ' \n'
        echo
    done
} >"$small/kept"
mv -- "$small/kept" "$kept"
wc -lc "$kept"
