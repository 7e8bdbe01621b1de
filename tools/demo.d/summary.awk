# Makes the table of a demo and the points of its learning curve from runs/POLICY-SEED.csv ...:
# -v object=, trials=, seeds=, curve= (file to write)
# Every figure is the mean over seeds of each seed's mean over the trials in question; its interval
# is t(0.975, seeds - 1) * s / sqrt(seeds). Aborted trials do not count.
BEGIN {
    FS = ","
    split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228 2.201 2.179 2.160 2.145 " \
          "2.131 2.120 2.110 2.101 2.093 2.086 2.080 2.074 2.069 2.064 2.060 2.056 2.052 2.048 " \
          "2.045 2.042", t_quantile, " ")
}
FNR == 1 {
    policy = FILENAME
    sub(/.*\//, "", policy)
    seed = policy
    sub(/-.*/, "", policy)
    sub(/^[a-z]*-/, "", seed)
    seed = int(seed)
    trial = 0
    next
}
$3 == "discovered" || $3 == "capped" {
    pushes[policy, seed, ++trial] = $2
    if ($3 == "capped")
        capped[policy]++
}

# The t quantile beyond the table, by its expansion in 1 / df (accurate to three digits there).
function t(df) {
    return df <= 30 ? t_quantile[df] : 1.95996 + 2.37226 / df + 2.8225 / (df * df)
}

# Sets mean and half, the interval's half width (-1 for one seed).
function estimate(policy, from, to,    s, k, m, sum, squares) {
    sum = squares = 0
    for (s = 1; s <= seeds; s++) {
        m = 0
        for (k = from; k <= to; k++)
            m += pushes[policy, s, k]
        value[s] = m / (to - from + 1)
        sum += value[s]
    }
    mean = sum / seeds
    for (s = 1; s <= seeds; s++)
        squares += (value[s] - mean) * (value[s] - mean)
    half = seeds > 1 ? t(seeds - 1) * sqrt(squares / (seeds - 1) / seeds) : -1
}

function cell(policy, from, to) {
    estimate(policy, from, to)
    return half < 0 ? sprintf("%6.1f        ", mean) : sprintf("%6.1f ± %-5.1f", mean, half)
}

function row(from, to, label,    learned, paper, random, learned_mean) {
    if (from > trials || from < 1)
        return
    if (to > trials)
        to = trials
    if (label == "")
        label = "trials " (from == to ? from : from "-" to)
    learned = cell("learn", from, to)
    learned_mean = mean
    paper = cell("paper", from, to)
    random = cell("random", from, to)
    printf "  %-14s %s    %s    %s    %8.0f%%\n", label, learned, paper, random,
           100 * (1 - learned_mean / mean)
}

function outcomes(policy, label) {
    printf "  %-9s %d of %d trials ended with the structure known, %d at the cap on pushes\n",
           label, seeds * trials - capped[policy], seeds * trials, capped[policy]
}

# Columns: trial, then for learned, random and paper: mean of the trial; mean, low and high of five trials.
function write_curve(    k, from, to, p, line, names) {
    split("learn random paper", names, " ")
    for (k = 1; k <= trials; k++) {
        from = k > 2 ? k - 2 : 1
        to = k + 2 <= trials ? k + 2 : trials
        line = k
        for (p = 1; p <= 3; p++) {
            estimate(names[p], k, k)
            line = line "\t" mean
            estimate(names[p], from, to)
            line = line "\t" mean "\t" (half > 0 ? mean - half : mean) \
                   "\t" (half > 0 ? mean + half : mean)
        }
        print line > curve
    }
}

END {
    printf "Pushes until the structure of %s is known\n", object
    if (seeds > 1)
        printf "mean over %d seeds ± 95%% confidence (t distribution)\n\n", seeds
    else
        printf "one seed: no confidence intervals\n\n"
    printf "  %-14s %14s    %14s    %14s    %s\n", "", "learned    ", "paper      ", "random     ",
           "fewer pushes"
    row(1, 5)
    row(6, 10)
    row(11, 20)
    row(21, 40)
    if (trials > 10)
        row(trials - 9, trials, "last 10")
    row(1, trials, "all")
    print ""
    outcomes("learn", "learned:")
    outcomes("paper", "paper:")
    outcomes("random", "random:")
    write_curve()
}
