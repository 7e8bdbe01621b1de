/* study.hpp: grrl-evaluate recordings, and its results. */
#ifndef GRRL_EXPERIMENT_RECORDINGS_STUDY_HPP
#define GRRL_EXPERIMENT_RECORDINGS_STUDY_HPP

#include <cstdio>
#include <string>
#include <vector>

#include "cli/options.h"
#include "grid.hpp"
#include "methods.hpp"
#include "score.hpp"

namespace grrl_experiment::recordings
{

struct Options {
    std::string grid; /* empty: each axis alone */
    int count = 5;    /* recordings in each cell */
    uint64_t seed = 1;
    int jobs = 1;
    std::string program; /* empty: the grrl-perceive next to this program */
    std::string csv;     /* empty: none, like the next two */
    std::string svg;
    std::string folder;
    bool quiet = false;
};
grrl_options_result parse_options(int argc, char **argv, Options &options);

struct Outcome {
    Score score;
    double ms = 0.0;
    bool failed = false;
};

/* One recording. */
struct Result {
    const Cell *cell = nullptr;
    uint64_t seed = 0;
    Outcome of[METHODS];
};

void print_table(std::FILE *file, const std::vector<Result> &results);
void print_csv(std::FILE *file, const std::vector<Result> &results);

/* false: gnuplot is missing or fails. */
bool draw_svg(const std::string &path, const std::vector<Result> &results);

/* The whole program; its exit status. */
int study(int argc, char **argv);

} // namespace grrl_experiment::recordings

#endif
