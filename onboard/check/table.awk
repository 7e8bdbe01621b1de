# Makes one table from the rows of all targets; each file is preceded by target=..
BEGIN { FS = "\t" }
FNR == 1 { targets++; head[targets] = target }
{
    what[FNR] = $1
    cell[FNR, targets] = sprintf(" %10s | %10s | %10s |", $2, $3, $4)
    rows = FNR
}
END {
    printf "\n| %-36s |", ""
    for (t = 1; t <= targets; t++)
        printf " %10s | %10s | %10s |", head[t], "", ""
    printf "\n|---|"
    for (t = 1; t <= targets; t++)
        printf "---|---|---|"
    printf "\n| %-36s |", ""
    for (t = 1; t <= targets; t++)
        printf " %10s | %10s | %10s |", "learn", "paper", "limit"
    print ""
    for (i = 1; i <= rows; i++) {
        printf "| %-36s |", what[i]
        for (t = 1; t <= targets; t++)
            printf "%s", cell[i, t]
        print ""
    }
}
