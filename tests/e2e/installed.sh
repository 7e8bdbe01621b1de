#!/bin/bash
# An installed copy that was moved: objects by name, in the build tree too; completion that tells the
# options of --help; man pages where there is help2man.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7739?ttl=0'
BUILD=$(dirname "$(dirname "$SIM")")
cmake --install "$BUILD" --prefix "$WORK/first" >install.txt 2>&1 || fail "cmake --install"
mv first moved
BIN=$WORK/moved/bin

for sim in "$SIM" "$BIN/grrl-sim"; do
    timeout 20 "$sim" --object wooden-toy --lcm-url memq:// --agent-timeout 0.1 >by_name.txt 2>&1
    [ $? = 1 ] || fail "$sim does not know wooden-toy"
    timeout 20 "$sim" --object wooden-tyo >typo.txt 2>&1
    [ $? = 2 ] || fail "$sim takes wooden-tyo"
    grep -q 'by name there are garden-shears, scissors, wooden-toy' typo.txt || fail "no names"
done
rm -r moved/share/grrl/objects/wooden-toy.grrl # from its own folder, not from the source
timeout 20 "$BIN/grrl-sim" --object wooden-toy >gone.txt 2>&1
[ $? = 2 ] || fail "the moved copy finds objects elsewhere"
start agent timeout 60 "$BIN/grrl-agent" --lcm-url "$URL"
agent=$LAST
timeout 60 "$BIN/grrl-sim" --lcm-url "$URL" --object scissors --trials 1 >sim.txt 2>&1 ||
    fail "scissors by name ended with $?"
finish "$agent" "the installed agent"

# complete PROGRAM WORD..: what bash offers for the last word
complete_words() {
    PATH=$BIN:$PATH bash -c '
        . "$1"
        shift
        COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMPREPLY=()
        _grrl "$1" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
        printf "%s\n" "${COMPREPLY[@]}"' bash "$@" | sort
}
for program in "$BIN"/grrl-*; do
    name=$(basename "$program")
    [ "$name" != grrl-bench ] || continue
    completion=$WORK/moved/share/bash-completion/completions/$name
    [ -f "$completion" ] || fail "no completion of $name"
    bash -c ". '$completion' && complete -p $name" >registered.txt 2>&1 ||
        fail "the completion does not know $name"
    "$program" --help | grep -oE '^  --[a-z0-9-]+' | tr -d ' ' | sort >help.txt
    [ "$(wc -l <help.txt)" -ge 3 ] || fail "$name --help has no options"
    complete_words "$completion" "$name" -- >offered.txt
    same help.txt offered.txt
    if grep -qx -e --policy help.txt && [ "$name" = grrl-agent ]; then
        [ "$(complete_words "$completion" "$name" --policy pa)" = paper ] || fail "--policy pa"
    fi
    if [ -n "$(find "$WORK/moved/share/man" -name 'grrl-sim.1' 2>/dev/null)" ]; then
        page=$(find "$WORK/moved/share/man" -name "$name.1")
        [ -s "$page" ] || fail "no man page of $name"
        grep -q "^$name \\\\- [a-z]" "$page" || fail "$name.1 does not say what it is"
        while read -r option; do
            sed 's/\\//g' "$page" | grep -q -e "$option" || fail "$name.1 lacks $option"
        done <help.txt
    fi
done
[ "$(complete_words "$completion" grrl-sim --object sci)" = scissors ] || fail "--object sci"
[ "$(complete_words "$completion" grrl-term can)" = canonical ] || fail "grrl-term can"
touch run.lcm
[ "$(complete_words "$completion" grrl-perceive --log run)" = run.lcm ] || fail "--log run"
exit 0
