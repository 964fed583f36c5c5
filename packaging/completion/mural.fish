# Completion of mural in fish. `mural complete` finds the words; this function shows them.

function __mural_complete
    set -l before (commandline -opc)
    set -l program $before[1]
    set -e before[1]
    set -l word (commandline -ct)
    set -l lines ($program complete -- mural $before $word 2>/dev/null)
    test (count $lines) -gt 0; or return
    set -l part (string split \t -- $lines[-1])
    set -e lines[-1]
    test (count $lines) -gt 0; and printf '%s\n' $lines

    set -l prefix ''
    test (count $part) -gt 1; and set prefix $part[2]
    set -l rest (string sub -s (math (string length -- "$prefix") + 1) -- $word)
    switch $part[1]
        case :program
            __fish_complete_subcommand --fcs-skip=$part[2]
        case :files
            for file in (__fish_complete_path "$rest" | string replace -r '\t.*' '')
                if test -z "$part[3]"; or string match -q -- '*/' $file; or string match -q -- $part[3] $file
                    printf '%s%s\n' $prefix $file
                end
            end
        case :folders
            for folder in (__fish_complete_directories "$rest" '' | string replace -r '\t.*' '')
                printf '%s%s\n' $prefix $folder
            end
        case :hosts
            for host in (__fish_print_hostnames)
                printf '%s%s\n' $prefix $host
            end
        case :command
            __fish_complete_command
    end
end

complete -c mural -f -a '(__mural_complete)'
