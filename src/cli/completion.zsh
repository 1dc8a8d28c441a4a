_gyrolab() {
    local -a found going whole home_going home_whole
    local line name
    # The program gets the words without the marks that keep the shell from reading them otherwise.
    found=("${(@f)$(_CLAP_IFS=$'\n' _CLAP_COMPLETE_INDEX=$((CURRENT - 1)) \
        VARIABLE=zsh gyrolab -- "${(@Q)words}" 2>/dev/null)}")
    for line in $found; do
        # A key waits for its value, and a folder for a name: no space after them. The ~ of a name stays one.
        name=${line%%:*}
        case $name in
            \~/*/) home_going+=("~/${(q)name#\~/}") ;;
            \~/*) home_whole+=("~/${(q)name#\~/}") ;;
            *[=/]) going+=("$line") ;;
            *) whole+=("$line") ;;
        esac
    done
    (( $#going )) && _describe -V 'values' going -S ''
    (( $#whole )) && _describe -V 'values' whole
    (( $#home_going )) && compadd -Q -S '' -- "${home_going[@]}"
    (( $#home_whole )) && compadd -Q -- "${home_whole[@]}"
}

# Loaded by compinit at the first use, the file is the function's body; else it is sourced.
if [[ ${funcstack[1]} == _gyrolab ]]; then
    _gyrolab "$@"
else
    compdef _gyrolab gyrolab
fi
