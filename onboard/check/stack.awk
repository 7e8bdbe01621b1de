# The deepest path through the call graphs gcc writes (-fcallgraph-info=su), and every cycle.
#   awk -f stack.awk -v root=main -v pointers="record.c=a,b learner.c=@policies" *.ci
# A call through a pointer in record.c may reach a and b; @policies are the functions of all files
# whose names end in _policy.c, the operations of the table. What has no size, of the C library or in
# assembly, counts as `unknown` bytes.
BEGIN {
    n = split(pointers, pairs, " ")
    for (i = 1; i <= n; i++) {
        split(pairs[i], pair, "=")
        reached[pair[1]] = pair[2]
    }
}
/^node:/ {
    split($0, part, "\"")
    if (match($0, /[0-9]+ bytes \([a-z,]*\)/)) {
        size[part[2]] = substr($0, RSTART, RLENGTH) + 0
        if ($0 ~ /dynamic/)
            complain(part[2] " has a frame of unbounded size")
        if ($0 ~ /_policy\.c:[0-9]/)
            operations = operations " " part[2]
    }
}
/^edge:/ {
    split($0, part, "\"")
    target = part[4]
    if (target == "__indirect_call") {
        sub(/:.*/, "", part[6])
        sub(/.*\//, "", part[6])
        target = "pointer:" part[6]
        if (!(part[6] in reached))
            complain("a call through a pointer in " part[6] ": `pointers` does not say where it leads")
    }
    calls[part[2]] = calls[part[2]] " " target
}
function complain(what) {
    print "stack: " what
    bad = 1
}
function deepest(name, below, n, callees, i, best, via) {
    if (state[name] == 1)
        complain("recursion through " name)
    if (name in depth || state[name] == 1 || name == skipped)
        return depth[name] + 0
    state[name] = 1
    n = split(calls[name], callees, " ")
    for (i = 1; i <= n; i++) {
        below = deepest(callees[i])
        if (below > best || via == "") {
            best = below
            via = callees[i]
        }
    }
    state[name] = 2
    next_of[name] = via
    own[name] = name in size ? size[name] : name ~ /^pointer:/ ? 0 : unknown
    return depth[name] = best + own[name]
}
END {
    if (!(root in size))
        complain("there is no function " root)
    for (file in reached) {
        gsub(/,/, " ", reached[file])
        sub(/@policies/, operations, reached[file])
        calls["pointer:" file] = " " reached[file]
    }
    for (name in size) # what the root does not reach must not recurse either
        deepest(name)
    if (bad)
        exit 1 # a path may have no end
    print "stack static", depth[root]
    for (name = root; name != ""; name = next_of[name])
        print "stack path", own[name], name
}
