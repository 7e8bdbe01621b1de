# Prints one line of progress from the results so far: runs/POLICY-SEED.csv ..., trial,pushes,outcome.
# -v finished=, total= (runs), trials= (of a run), elapsed= (s), running= (names of runs)
BEGIN { FS = "," }
FNR == 1 {
    name = FILENAME
    sub(/.*\//, "", name)
    sub(/[.]csv$/, "", name)
    policy = name
    sub(/-.*/, "", policy)
    next
}
$3 == "discovered" || $3 == "capped" {
    done++
    n[policy]++
    pushes[policy] += $2
    trial[name]++
    last[name] = $2
}
function mean(policy) {
    return n[policy] ? sprintf("%.1f", pushes[policy] / n[policy]) : "-"
}
END {
    left = "?"
    if (done > 0 && elapsed >= 2) {
        s = int(elapsed * (total * trials - done) / done + 0.5)
        left = sprintf("%d:%02d", int(s / 60), s % 60)
    }
    line = sprintf("%d of %d runs, %s left | mean pushes: learned %s, paper %s, random %s",
                   finished, total, left, mean("learn"), mean("paper"), mean("random"))
    count = split(running, names, " ")
    for (i = 1; i <= count; i++)
        if (trial[names[i]] > 0)
            line = line sprintf(" | %s trial %d: %d pushes", names[i], trial[names[i]],
                                last[names[i]])
    print line
}
