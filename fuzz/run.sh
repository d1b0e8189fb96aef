#!/bin/sh
# Fuzzes one target: fuzz/run.sh TARGET [SECONDS]. What it learns stays in fuzz/corpus/TARGET; a finding in fuzz/artifacts.
set -eu
cd "$(dirname -- "$0")"
target=${1:?which target? $(ls fuzz_targets)}
seconds=${2:-600}
mkdir -p "corpus/$target"

# Begin with what was kept.
kept=../fixtures/fuzz/$target.hex
if [ -f "$kept" ]; then
    number=0
    while read -r line; do
        number=$((number + 1))
        # hexadecimal -> octal escapes -> bytes
        printf '%b' "$(printf '%s' "${line#!}" | sed 's/../0x& /g' | xargs -n1 printf '\\0%03o')" >"corpus/$target/kept-$number"
    done <"$kept"
fi

case $target in
    mount_replies) longest=192 ;;
    settings | rig_file) longest=2048 ;;
    *) longest=1024 ;;
esac
dictionary=dictionaries/$target.dict
[ ! -f "$dictionary" ] || set -- "-dict=$dictionary"
[ -f "$dictionary" ] || set --
exec nice -n 19 cargo +nightly fuzz run "$target" -- "$@" \
    "-max_total_time=$seconds" "-max_len=$longest" -timeout=10 -rss_limit_mb=2048 -print_final_stats=1
