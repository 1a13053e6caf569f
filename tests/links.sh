#!/usr/bin/env bash
# Checks whether every http link in the documents answers: prints those that do not, and then fails. Run by
# hand, since it needs a network.
#   tests/links.sh [FILE...]     (without any: README.md and the pages below docs)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# == 0)); then
    mapfile -t pages < <(find docs -name '*.md' | sort)
    set -- README.md "${pages[@]}"
fi
mapfile -t links < <(grep -ohE 'https?://[^][[:space:]()<>"`|]+' "$@" | sed -E "s/[.,;:!?']+\$//" | sort -u)

# The status at the end of a link, or 000: from its header or, if a server does not answer that, from its
# first byte.
statusOf() { # LINK
    local status=000 how
    for how in --head '--range 0-0'; do
        # shellcheck disable=SC2086
        status=$(curl --silent --location --max-time 30 --output /dev/null --write-out '%{http_code}' $how "$1" || true)
        [[ $status != 2?? ]] || break
    done
    echo "$status"
}

dead=0
for link in "${links[@]}"; do
    status=$(statusOf "$link")
    [[ $status != 2?? ]] || continue
    echo "$status $link  ($(grep -lF -- "$link" "$@" | tr '\n' ' ' | sed 's/ $//'))"
    dead=$((dead + 1))
done
echo "links: $((${#links[@]} - dead)) of ${#links[@]} answer"
((dead == 0))
