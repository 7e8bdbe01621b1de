# Finds the deepest path through gcc's call graphs (-fcallgraph-info=su), and every cycle.
#   awk -f stack.awk -v root=main -v callbacks="a b" *.ci
# A call through a pointer may reach each of `callbacks`. Functions of unknown size (C library,
# assembly) count as `unknown` bytes.
/^node:/ {
    split($0, part, "\"")
    if (match($0, /[0-9]+ bytes \([a-z,]*\)/)) {
        size[part[2]] = substr($0, RSTART, RLENGTH) + 0
        if ($0 ~ /dynamic/)
            complain(part[2] " has a frame of unbounded size")
    }
}
/^edge:/ {
    split($0, part, "\"")
    calls[part[2]] = calls[part[2]] " " part[4]
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
    own[name] = name in size ? size[name] : name == "__indirect_call" ? 0 : unknown
    return depth[name] = best + own[name]
}
END {
    if (!(root in size))
        complain("there is no function " root)
    calls["__indirect_call"] = " " callbacks
    for (name in size) # what the root does not reach must not recurse either
        deepest(name)
    if (bad)
        exit 1 # a path may have no end
    print "stack static", depth[root]
    for (name = root; name != ""; name = next_of[name])
        print "stack path", own[name], name
}
