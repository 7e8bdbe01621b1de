/* options.cpp: the table of grrl-evaluate's options. */
#include "options.hpp"

#include <cstdlib>

#include "cli/options.hpp"
#include "objects.hpp"

namespace grrl_experiment::perception
{

namespace
{

const char *take_noise(void *context, const char *text)
{
    auto &noise = *static_cast<std::vector<double> *>(context);
    noise.clear();
    for (const char *at = text;; at++) {
        char *end;
        double level = std::strtod(at, &end);
        if (end == at || (*end != '\0' && *end != ',') || !(level > 0.0 && level <= 100.0))
            return "numbers above 0 to 100, separated by commas, such as 1,2";
        noise.push_back(level);
        if (*end == '\0')
            return nullptr;
        at = end;
    }
}

} // namespace

grrl_program describe_study(const char *usage, const char *intro, std::string &outro)
{
    outro += "The same seed gives the same figures, whatever --jobs is.\n"
             "Exit status: 0 fine; 1 failed; 2 wrong command line.\n";
    return {"grrl-evaluate", usage, intro,
            outro.c_str(),   1,     "there are two studies: perception and recordings"};
}

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    grrl_sim::TrackerParams &tracker = o.trial.world.tracker;
    const grrl_option rows[] = {
        grrl_option_text("objects", "LIST",
                         "names below, chains, terms or files, separated by semicolons (all)",
                         &o.objects),
        grrl_option_int("trials", "N", "trials for each object and noise level (50)", 1, 1000000,
                        &o.trials),
        grrl_option_u64("seed", "N", "seed of the first trial; the next ones count up (1)", 0,
                        UINT64_MAX - 1000000, &o.seed),
        grrl_option_call("noise", "LIST", "noise levels, in units of the default of 0.7 mm (1,2)",
                         take_noise, &o.noise),
        grrl_option_number("dropout", "P", "probability that a feature is missing in a frame (0)",
                           0.0, 1.0, 1.0, &tracker.dropout_probability),
        grrl_option_number("outliers", "P",
                           "probability that a feature is displaced in a frame (0)", 0.0, 1.0, 1.0,
                           &tracker.outlier_probability),
        grrl_option_int("cap", "N", "pushes after which a trial ends unsolved (100)", 1, 1000000,
                        &o.trial.cap),
        grrl_option_int("jobs", "N", "number of trials in parallel (1)", 1, 256, &o.jobs),
        grrl_option_text("csv", "FILE", "write every figure and its counts", &o.csv),
        grrl_option_text("svg", "FILE", "draw the figures (needs gnuplot)", &o.svg),
        grrl_option_flag("quiet", "no progress", &o.quiet),
    };
    std::string outro = "Objects: " + object_names() + "\n";
    const grrl_program program = describe_study(
        "grrl-evaluate perception [OPTION]...\n       grrl-evaluate recordings --help",
        "Measures perception on simulated objects under random pushes, against the\n"
        "truth and against the baseline of the paper, in one run.\n",
        outro);
    int first = 0;
    grrl_options_result result =
        grrl_options_parse(&program, rows, std::size(rows), argc, argv, &first);
    if (result == GRRL_OPTIONS_RUN && (first == argc || std::string(argv[first]) != "perception"))
        return grrl_options_wrong(&program, "no study: name perception or recordings");
    return result;
}

} // namespace grrl_experiment::perception
