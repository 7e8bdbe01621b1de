# awk -f rooms.awk rooms.txt FILE..: the #include lines of the library's files, given as paths from
# the project's folder, against the table of rooms. Prints what does not hold; exit status 1 then.

function complain(text) {
    print text
    failed = 1
}

# The room of a path below lib: the longest that the table knows; "" for the umbrella.
function room_of(path,    folder) {
    folder = path
    if (!sub(/^lib\/include\/grrl\//, "", folder))
        sub(/^lib\/src\//, "", folder)
    if (!sub(/\/[^\/]*$/, "", folder))
        return ""
    return folder
}

function add_room(    i) {
    rooms[$1] = ++n_rooms
    for (i = 2; i <= NF; i++) {
        if (!($i in rooms) || $i == $1)
            complain(FILENAME ":" FNR ": " $1 " uses " $i ", which must stand above it")
        uses[$1, $i] = 1
    }
}

function read_table(    i) {
    if ($1 == "system")
        for (i = 2; i <= NF; i++)
            system_header[$i] = 1
    else if ($1 == "generated")
        generated[$2] = 1
    else
        add_room()
}

# The path of what a file includes, as of one of ours; "" if it is none
function resolve(name) {
    if (name ~ /^grrl\//)
        return "lib/include/" name
    return ("lib/src/" name) in is_file ? "lib/src/" name : ""
}

function check_arrow(file, line, name,    target, from, to) {
    if (name in generated)
        return
    target = resolve(name)
    if (target == "" || !(target in is_file)) {
        complain(file ":" line ": " name ": no such file in lib/include or lib/src")
        return
    }
    included[file] = included[file] " " target
    if (file ~ /^lib\/include\// && target !~ /^lib\/include\//)
        complain(file ":" line ": a public header includes the private " name)
    from = room_of(file)
    to = room_of(target)
    if (from == "")
        return
    if (from == to || ((from, to) in uses))
        return
    if (to == "")
        complain(file ":" line ": " from " includes the umbrella " name)
    else
        complain(file ":" line ": " from " must not use " to " (" name ")")
}

# Depth first; state 1: on the path, 2: no circle behind it
function visit(file, path,    names, n, i) {
    if (state[file] == 1)
        complain("a circle:" path " " file)
    if (state[file])
        return
    state[file] = 1
    n = split(included[file], names, " ")
    for (i = 1; i <= n; i++)
        visit(names[i], path " " file)
    state[file] = 2
}

BEGIN {
    for (i = 2; i < ARGC; i++)
        is_file[ARGV[i]] = 1
    if (ARGC < 3)
        complain("there are no files to read")
}

FILENAME == ARGV[1] {
    if ($0 !~ /^ *(#|$)/)
        read_table()
    next
}

FNR == 1 && room_of(FILENAME) != "" && !(room_of(FILENAME) in rooms) {
    complain(FILENAME ": the folder is no room of " ARGV[1])
}

/^[ \t]*#[ \t]*include/ {
    name = $0
    sub(/^[ \t]*#[ \t]*include[ \t]*/, "", name)
    own = name ~ /^"/ || name ~ /^<grrl\//
    sub(/^["<]/, "", name)
    sub(/[">].*/, "", name)
    n_includes++
    if (own)
        check_arrow(FILENAME, FNR, name)
    else if (!(name in system_header))
        complain(FILENAME ":" FNR ": the library does without <" name ">")
}

END {
    for (file in is_file)
        visit(file, "")
    if (!failed)
        print ARGC - 2 " files, " n_includes " includes, " n_rooms " rooms: no arrow runs up"
    exit failed
}
