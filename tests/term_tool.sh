#!/bin/sh
# grrl-term by its exact output and exit status: term_tool.sh PATH_OF_GRRL_TERM VERSION
tool=$1
version=$2
failures=0

# expect STATUS OUTPUT ARGUMENT...: standard output and standard error together
expect() {
    status=$1
    output=$2
    shift 2
    actual=$("$tool" "$@" 2>&1)
    actual_status=$?
    if [ "$actual" != "$output" ] || [ "$actual_status" -ne "$status" ]; then
        printf 'grrl-term %s\nexpected (%s):\n%s\nactual (%s):\n%s\n\n' \
            "$*" "$status" "$output" "$actual_status" "$actual"
        failures=$((failures + 1))
    fi
}

expect 0 "grrl-term $version" --version

# parse
expect 0 'D(lb, R(L(s, f1), f2))' parse ' D( lb,R(L(s ,f1),f2) )'
expect 0 'A(v3, 45)' parse 'A(v3, 45°)'
expect 0 'R(blade1, L(s, Tip)) & R' parse 'R(L(blade1), L(s, Tip)) & R'
expect 0 'R(l1, l2)' parse - <<'END'
R(l1,
  l2)
END
expect 1 "grrl-term: 1:6: expected ',', ')' or '&' after an argument of a relation, found 'l2'
  R(l1 l2)
       ^" parse 'R(l1 l2)'
expect 1 "grrl-term: 2:6: expected ')' after the direction of an action, found 'x'
  	45° x)
  	    ^" parse 'A(f1,
	45° x)'
expect 1 "grrl-term: 1:8: expected ',', ')' or '&' after an argument of a relation, found the end of the text
  R(l1,l2
         ^" parse - <<'END'
R(l1,l2
END

# graph
expect 0 'link f3 s
link f1
link f2 l _ red
joint P f1 f2
joint R f3 f1' graph 'D(lb, R(L(s, f3), P(f1, L(l, _, red, f2))))'
expect 0 'graph structure {
  "f1" [label="f1 s"];
  "lb" [label="lb"];
  "f1" -- "lb" [label="R"];
}' graph --dot 'R(L(s, f1), lb)'
expect 0 'graph structure {
  "node" [label="node"];
  "s" [label="s l"];
  "node" -- "s" [label="P"];
}' graph --dot 'P(node, L(l, s))'
expect 0 'link blade1
link blade2 l
joint R blade1 blade2' graph 'D(lb, R(blade1, L(l, blade2)))'
expect 1 'grrl-term: link l1 is joined to itself' graph 'R(l1, l1)'
expect 1 'grrl-term: link tip is joined twice to blade1' graph 'R(blade1, tip) & P(tip, blade1)'
expect 1 'grrl-term: an action is not a structure' graph 'A(l1, 90)'

# canonical: the wooden toy, written in two ways
toy='R(v2, R(v4, P(v3, v1)))
hash d3865b00'
expect 0 "$toy" canonical 'D(lb, R(l4, R(l3, P(l1, l2))))'
expect 0 "$toy" canonical 'D(P(l4, R(R(l1, l2), l3)), lb)'
expect 0 "$toy" canonical --ignore-properties 'R(L(s, f4), R(L(s, f3), P(L(l, f1), L(s, f2))))'
expect 0 'D(v1, R(lb, L(s, v2)))
hash 4dce33ed' canonical 'R(L(s, f1), lb) & f2'

expect 0 "$toy" canonical 'R(stick, R(wheel, P(P, box)))'

# match: the example of the paper's section V-D, and sub-structures
expect 0 'isomorphic, ignoring property 1
f1 <-> v1
f2 <-> v2
f3 <-> v3' match 'R(R(L(l, f1), L(s, f2)), L(l, f3))' 'R(R(L(s, v1), L(s, v2)), L(s, v3))'
expect 0 'isomorphic
f1 <-> v3
f2 <-> v2
or
f1 <-> v2
f2 <-> v3' match --all 'R(f1, f2)' 'R(v3, v2)'
expect 0 'A is a sub-structure of B
f1 <-> l2
f2 <-> l3' match 'R(f1, f2)' 'P(l1, R(l2, l3))'
expect 0 'B is a sub-structure of A, ignoring properties 2 1
f1 <-> l1
f2 <-> l2' match 'R(P(L(s, red, f1), f2), f3)' 'P(L(l, l1), l2)'
expect 0 'A is a sub-structure of B
blade1 <-> arm
blade2 <-> hand' match 'R(blade1, blade2)' 'P(base, R(arm, hand))'
expect 1 'no match' match 'R(l1, l2)' 'P(l1, l2)'
expect 1 'grrl-term: 1:1: expected a link or one of R, P, D, A, found '"'9x'"'
  9x
  ^' match l1 9x

# usage
try='Try grrl-term --help'
expect 2 "grrl-term: the command is parse, graph, canonical, match, rules or merge
$try"
expect 2 "grrl-term: the command is parse, graph, canonical, match, rules or merge
$try" pares l1
expect 2 "grrl-term: --dot requires graph
$try" parse --dot l1
expect 2 "grrl-term: --ignore-properties requires canonical
$try" graph l1 --ignore-properties
expect 2 "grrl-term: --all requires match
$try" --all canonical l1
expect 2 "grrl-term: too few terms
$try" match l1
expect 2 "grrl-term: one term too many
$try" parse l1 l2
expect 2 "grrl-term: one term too many
$try" match l1 l2 l3
expect 2 "grrl-term: only one term can come from standard input
$try" match - -

help=$("$tool" --help) || failures=$((failures + 1))
for word in parse graph canonical match --dot --ignore-properties --all 'Exit status'; do
    case $help in
    *"$word"*) ;;
    *)
        echo "--help says nothing of $word"
        failures=$((failures + 1))
        ;;
    esac
done

# rules and merge, on the store that comes with grrl
store=$(dirname "$0")/../examples/mixed.store
work=$(mktemp -d)
"$tool" rules "$store" >"$work/rules" || failures=$((failures + 1))
if ! grep -q '^ *[0-9]*% of  *[0-9]*  .*A(x, .*) if ' "$work/rules" ||
    ! tail -1 "$work/rules" | grep -q '^[0-9]* rules for 1000 cases of [0-9]* pushes$' ||
    [ "$(grep -c ' A(x, ' "$work/rules")" -ne "$(tail -1 "$work/rules" | cut -d' ' -f1)" ]; then
    echo "the rules of $store:"
    cat "$work/rules"
    failures=$((failures + 1))
fi
expect 0 '' merge "$store" "$store" "$work/twice"
expect 1 "grrl-term: cannot write $work/twice; a new file in a folder is required" \
    merge "$store" "$store" "$work/twice"
expect 1 "grrl-term: $0: not a file of this kind; a store that grrl-agent --policy learn wrote is required" \
    rules "$0"
expect 1 "grrl-term: cannot read $work/none" rules "$work/none"
"$tool" merge "$store" "$work/twice" "$work/ab" && "$tool" merge "$work/twice" "$store" "$work/ba"
if ! cmp "$work/ab" "$work/ba"; then
    echo "merge depends on the order"
    failures=$((failures + 1))
fi
expect 0 '' merge "$store" "$store" "$work/twice" "$work/three"
expect 2 "grrl-term: merge requires two or more stores and a new file
$try" merge "$store" "$work/one"
rm -r "$work"

[ "$failures" -eq 0 ] || {
    echo "$failures failures"
    exit 1
}
