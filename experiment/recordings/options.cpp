/* options.cpp: the command line of grrl-evaluate recordings. */
#include "cli/options.hpp"

#include "perception/options.hpp"
#include "study.hpp"

namespace grrl_experiment::recordings
{

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    const grrl_option rows[] = {
        grrl_option_text("grid", "AXES",
                         "axes to cross, separated by semicolons, such as\n"
                         "'camera=roll,zoom; objects=R,two' (each axis alone)",
                         &o.grid),
        grrl_option_int("count", "N", "recordings in each cell of the grid (5)", 1, 1000000,
                        &o.count),
        grrl_option_u64("seed", "N",
                        "seed of the first recording of a cell; the next ones count up (1)", 0,
                        UINT64_MAX - 1000000, &o.seed),
        grrl_option_text("program", "PATH",
                         "the grrl-perceive to measure (the one next to this program)", &o.program),
        grrl_option_int("jobs", "N", "number of recordings in parallel (1)", 1, 256, &o.jobs),
        grrl_option_text("csv", "FILE", "write a row for each recording and method", &o.csv),
        grrl_option_text("svg", "FILE", "draw the figures (needs gnuplot)", &o.svg),
        grrl_option_text("write", "FOLDER", "write the recordings, for grrl-perceive", &o.folder),
        grrl_option_flag("quiet", "no progress", &o.quiet),
    };
    std::string outro = "Axes and their levels; the first is the usual one:\n" + grid_help();
    const grrl_program program = perception::describe_study(
        "grrl-evaluate recordings [OPTION]...",
        "Measures grrl-perceive on synthetic recordings of cameras and trackers, against the\n"
        "truth, the skill of the paper and merging by BIC, in one run.\n",
        outro);
    return grrl_options_parse(&program, rows, std::size(rows), argc, argv, nullptr);
}

} // namespace grrl_experiment::recordings
