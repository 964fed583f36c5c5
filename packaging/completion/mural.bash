# Completion of mural in bash. `mural complete` finds the words; this script shows them.
# Source it, or install it as /usr/share/bash-completion/completions/mural.

_mural() {
    local cur=${COMP_WORDS[COMP_CWORD]}
    local -a words=("${COMP_WORDS[@]:0:COMP_CWORD+1}")
    # Readline divides words at '=', ':' and '@' as well. bash-completion joins them again.
    if declare -F _get_comp_words_by_ref >/dev/null; then
        local cword
        _get_comp_words_by_ref -n '=:@' cur words cword
        words=("${words[@]:0:cword+1}")
    fi
    local program=${words[0]}
    words[0]=mural
    local -a lines
    mapfile -t lines < <("$program" complete -- "${words[@]}" 2>/dev/null)
    [[ ${#lines[@]} -gt 0 ]] || return 0

    local -a part
    IFS=$'\x1f' read -r -a part <<<"${lines[-1]//$'\t'/$'\x1f'}"
    unset 'lines[-1]'
    COMPREPLY=("${lines[@]%%$'\t'*}")
    local prefix=${part[1]-} pattern=${part[2]-} rest word
    rest=${cur#"$prefix"}
    case ${part[0]} in
    :program)
        # The program has its own completion.
        if declare -F _command_offset >/dev/null; then
            local first=$((COMP_CWORD - (${#words[@]} - 1) + part[1]))
            _command_offset "$first"
        else
            mapfile -t COMPREPLY < <(compgen -c -- "$rest")
        fi
        return 0
        ;;
    :files)
        compopt -o filenames 2>/dev/null
        while IFS= read -r word; do
            # shellcheck disable=SC2053 # the pattern is a glob
            [[ -z $pattern || -d $word || $word == $pattern ]] && COMPREPLY+=("$prefix$word")
        done < <(compgen -f -- "$rest")
        ;;
    :folders)
        compopt -o filenames 2>/dev/null
        while IFS= read -r word; do COMPREPLY+=("$prefix$word"); done < <(compgen -d -- "$rest")
        ;;
    :hosts)
        while IFS= read -r word; do COMPREPLY+=("$prefix$word"); done < <(_mural_hosts "$rest")
        ;;
    :command)
        while IFS= read -r word; do COMPREPLY+=("$prefix$word"); done < <(compgen -c -- "$rest")
        ;;
    esac
    # Readline replaces only the text after its last divider.
    local kept=${cur%"${cur##*[=:@]}"} i
    if [[ -n $kept ]]; then
        for i in "${!COMPREPLY[@]}"; do COMPREPLY[i]=${COMPREPLY[i]#"$kept"}; done
    fi
}

# Prints the known hosts that begin with $1.
_mural_hosts() {
    if declare -F _known_hosts_real >/dev/null; then
        local -a COMPREPLY=()
        _known_hosts_real -- "$1"
        ((${#COMPREPLY[@]} == 0)) || printf '%s\n' "${COMPREPLY[@]}"
    else
        compgen -A hostname -- "$1"
    fi
}

complete -F _mural mural
