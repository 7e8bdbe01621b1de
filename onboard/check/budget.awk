# A table from what the image, stack.awk and size -A say; the status tells whether it fits.
function row(what, value, limit) {
    printf "| %-38s | %10s | %10s |\n", what, value, limit
    if (limit != "" && value + 0 > limit + 0)
        over = over "  " what
}
$1 == "cost" { n[$2] = $3; mean[$2] = $4; most[$2] = $5 }
$1 == "ram" { part[$2] = $3; order[++parts] = $2; sum += $3 }
$1 == "stack" && $2 == "painted" { painted = $3 }
$1 == "stack" && $2 == "static" { static = $3 }
$1 == "used" { used[$2] = $3 }
$1 ~ /^\.(vectors|text|ARM\.exidx|data)$/ { flash += $2 }
$1 ~ /^\.(stack|data|bss)$/ { ram += $2 }
END {
    small = target == "cortex-m4"
    printf "\n| %-38s | %10s | %10s |\n", target, "measured", "limit"
    print "|---|---|---|"
    row("flash, bytes", flash, 131072)
    row("RAM, bytes", ram, small ? 262144 : 327680)
    for (i = 1; i <= parts; i++)
        row("  of it " order[i], part[order[i]], "")
    row("  of it all else", ram - sum, "")
    row("stack painted over, bytes", painted, static)
    row("stack at most, by the call graph", static, part["stack"])
    split("frame perceive choose learn", steps, " ")
    for (i = 1; i <= 4; i++) {
        step = steps[i]
        row("instructions a " step ", mean of " n[step], mean[step], "")
        row("instructions a " step ", most", most[step],
            step == "choose" || step == "learn" ? 10000000 : "")
    }
    row("experiences in use at the end", used["experiences"], "")
    if (over != "")
        print "over the limit:" over
    exit over != "" || n["choose"] == 0
}
