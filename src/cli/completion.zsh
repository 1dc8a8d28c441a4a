_gyrolab() {
    local -a found going whole
    local line
    found=("${(@f)$(_CLAP_IFS=$'\n' _CLAP_COMPLETE_INDEX=$((CURRENT - 1)) \
        VARIABLE=zsh gyrolab -- "${words[@]}" 2>/dev/null)}")
    for line in $found; do
        # A key waits for its value, and a folder for a name: no space after them.
        case ${line%%:*} in
            *[=/]) going+=("$line") ;;
            *) whole+=("$line") ;;
        esac
    done
    (( $#going )) && _describe -V 'values' going -S ''
    (( $#whole )) && _describe -V 'values' whole
}

# Loaded by compinit at the first use, the file is the function's body; else it is sourced.
if [[ ${funcstack[1]} == _gyrolab ]]; then
    _gyrolab "$@"
else
    compdef _gyrolab gyrolab
fi
