# Bash completion for the programs of grrl. It asks the program itself: what --help tells can be
# completed, so that there is no second list of options.

# _grrl_rows PROGRAM: its options as --help has them, "--name" or "--name ARGUMENT"
_grrl_rows() {
    "$1" --help 2>/dev/null | sed -nE 's/^  (--[a-z0-9-]+( [A-Za-z0-9,.:|=[/]+\]?)?)(  .*)?$/\1/p'
}

# _grrl_words PROGRAM: what its first argument may be, from the lines of usage
_grrl_words() {
    "$1" --help 2>/dev/null | sed -nE 's/^(Usage:|      ) grrl-[a-z]+ ([a-z|]+) .*/\2/p' | tr '|' '\n'
}

# _grrl_values PROGRAM OPTION ARGUMENT: what may follow the option
_grrl_values() {
    local program=$1 folder
    case $2 in
    --policy)
        "$program" --help | sed -nE 's/^ {8,}([a-z]+): .*/\1/p; s/^  ([a-z]+[a-z0-9.-]*)  +.*/\1/p'
        ;;
    --object)
        folder=$(dirname "$(readlink -f "$(command -v "$program")")")/../share/grrl/objects
        find -L "$folder" -name '*.grrl' 2>/dev/null | sed 's|.*/||; s|[.]grrl$||'
        ;;
    *)
        [[ $3 != *[a-z]*'|'* ]] || tr '|' '\n' <<<"$3"
        ;;
    esac
}

_grrl() {
    local program=$1 current=$2 before=$3 row rows argument=
    COMPREPLY=()
    rows=$(_grrl_rows "$program")
    while read -r row; do
        [[ $row == "$before "* ]] && argument=${row#* }
    done <<<"$rows"
    if [[ -n $argument ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_grrl_values "$program" "$before" "$argument")" -- "$current")
        [[ $argument != *FILE* && $argument != PATH && $argument != DIR && $argument != OBJECT ]] ||
            mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -f -- "$current")
    elif [[ $current == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(sed "s/ .*//" <<<"$rows")" -- "$current")
    elif [[ $COMP_CWORD -eq 1 && -n $(_grrl_words "$program") ]]; then
        mapfile -t COMPREPLY < <(compgen -W "$(_grrl_words "$program")" -- "$current")
    else
        mapfile -t COMPREPLY < <(compgen -f -- "$current")
    fi
}

complete -o filenames -F _grrl grrl-agent grrl-bridge grrl-evaluate grrl-experiment grrl-perceive \
    grrl-sim grrl-term grrl-track grrl-view
