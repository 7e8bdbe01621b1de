# The table rows of one target, separated by tabs: item, with the policy learn, with the policy paper,
# limit. Reads the output of stack.awk, size -A and the image (one file per policy, preceded by
# policy=..). The status says whether everything fits.
function row(what, learn, paper, limit) {
    printf "%s\t%s\t%s\t%s\n", what, learn, paper, limit
    if (limit != "" && (learn + 0 > limit + 0 || paper + 0 > limit + 0))
        over = over "\n  " what
}
$1 == "cost" { n[policy, $2] = $3; mean[policy, $2] = $4; most[policy, $2] = $5 }
$1 == "ram" && policy == "learn" { part[$2] = $3; order[++parts] = $2; sum += $3 }
$1 == "stack" && $2 == "painted" { painted[policy] = $3 }
$1 == "stack" && $2 == "static" { static = $3 }
$1 == "worst" { worst[$2] = $3 }
$1 == "used" { used[policy, $2] = $3 }
$1 ~ /^\.(vectors|text|ARM\.exidx|data)$/ { flash += $2 }
$1 ~ /^\.(stack|data|bss)$/ { ram += $2 }
$1 == "alone" && $2 ~ /^\.(vectors|text|ARM\.exidx|data)$/ { flash_alone += $3 }
$1 == "alone" && $2 ~ /^\.(stack|data|bss)$/ { ram_alone += $3 }
END {
    row("flash, bytes", flash, flash, 131072)
    row("RAM, bytes", ram, ram, target == "cortex-m4" ? 262144 : 327680)
    for (i = 1; i <= parts; i++)
        row("  of it " order[i], part[order[i]], part[order[i]], "")
    row("  of it all else", ram - sum, ram - sum, "")
    row("flash with that policy alone", flash_alone, "", target == "cortex-m4" ? 61440 : "")
    row("RAM with that policy alone", ram_alone, "", "")
    row("stack painted over, bytes", painted["learn"], painted["paper"], static)
    row("stack at most, by the call graph", static, static, part["stack"])
    split("frame perceive choose learn", steps, " ")
    for (i = 1; i <= 4; i++) {
        step = steps[i]
        row(step ", how often", n["learn", step], n["paper", step], "")
        row("  instructions, mean", mean["learn", step], mean["paper", step], "")
        row("  instructions, most", most["learn", step], most["paper", step], "")
    }
    # Choose and learn together, with full stores and states of all links, which a run does not reach.
    row("a decision at full capacity, most", worst["learn"], worst["paper"], 10000000)
    row("entries in use at the end", used["learn", "entries"], used["paper", "entries"],
        256)
    if (over != "")
        print "over the limit:" over > "/dev/stderr"
    missing = n["learn", "choose"] == 0 || n["paper", "choose"] == 0 || worst["learn"] == 0 ||
              worst["paper"] == 0 || static == "" || flash_alone == 0
    exit over != "" || missing
}
