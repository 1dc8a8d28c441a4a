_gyrolab() {
    # bash parts a word at = and at :, where a value of gyrolab may hold both: the parts are put together again.
    local -a words=()
    local i word joined=false quote=
    for ((i = 0; i <= COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        ((i == COMP_CWORD)) && [[ $word != [=:]* ]] && word=$2
        # The program gets the word without the marks that keep the shell from reading it otherwise.
        quote=
        [[ $word == [\"\']* ]] && quote=${word:0:1} && word=${word:1}
        [[ -z $quote ]] && word=${word//\\/}
        if ((${#words[@]})) && [[ $word == [=:]* || $joined == pending ]]; then
            words[${#words[@]} - 1]+=$word
            joined=true
            [[ $word == *[=:] ]] && joined=pending
        else
            words+=("$word")
            joined=false
        fi
    done
    local current=${words[${#words[@]} - 1]} prefix=
    [[ $joined != false ]] && prefix=${current%"${current##*[=:]}"}
    local reply home
    COMPREPLY=()
    while IFS= read -r reply || [[ -n $reply ]]; do
        reply=${reply#"$prefix"}
        # A name of a file may hold what the shell would read otherwise, unless it stands in quotes.
        if [[ -z $quote && $reply == *[\][:space:]\"\'\\\$\`\(\)\[\&\;\|\<\>\*\?\!]* ]]; then
            home=
            [[ $reply == '~/'* ]] && home='~/'
            printf -v reply '%s%q' "$home" "${reply#"$home"}"
        fi
        COMPREPLY+=("$reply")
    done < <(_CLAP_IFS=$'\n' _CLAP_COMPLETE_INDEX=$((${#words[@]} - 1)) \
        VARIABLE=bash gyrolab -- "${words[@]}" 2>/dev/null)
    if ((${#COMPREPLY[@]} == 1)) && [[ ${COMPREPLY[0]} == *[=/] ]]; then
        compopt -o nospace 2>/dev/null
    fi
}
complete -o bashdefault -F _gyrolab gyrolab
