/* study.cpp: runs all methods on all recordings of a grid, in several threads. */
#include "study.hpp"

#include <mutex>
#include <stdexcept>

#include <unistd.h>

#include "files.hpp"
#include "progress.hpp"

namespace grrl_experiment::recordings
{

namespace
{

enum { EXIT_FINE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

/* grrl-perceive next to this program or in the build tree, or the one in $PATH. */
std::string program_beside_us()
{
    char self[4096];
    ssize_t n = readlink("/proc/self/exe", self, sizeof self - 1);
    std::string folder(self, n > 0 ? static_cast<size_t>(n) : 0);
    folder.erase(std::min(folder.rfind('/') + 1, folder.size()));
    for (const char *path : {"grrl-perceive", "../perceive/grrl-perceive"})
        if (access((folder + path).c_str(), X_OK) == 0)
            return folder + path;
    return "grrl-perceive";
}

class Study
{
public:
    Study(const Options &options, const std::vector<Cell> &cells)
        : options_(options), cells_(cells),
          program_(options.program.empty() ? program_beside_us() : options.program),
          count_(static_cast<size_t>(options.count)), results_(cells.size() * count_)
    {
    }

    /* An empty text or an error message. */
    std::string run()
    {
        auto try_next = [&](size_t i) {
            std::string wrong = try_one(i);
            std::lock_guard<std::mutex> lock(mutex_);
            wrong_ = wrong.empty() ? wrong_ : wrong;
            return wrong.empty() ? 0 : -1;
        };
        run_parallel(results_.size(), options_.jobs, options_.quiet, "recordings", try_next);
        return wrong_;
    }

    const std::vector<Result> &results() const { return results_; }

private:
    std::string try_one(size_t i)
    {
        try {
            return one(i);
        } catch (const std::runtime_error &error) { /* from a file */
            return error.what();
        }
    }

    std::string one(size_t i)
    {
        Result &result = results_[i];
        result.cell = &cells_[i / count_];
        result.seed = options_.seed + i % count_;
        Recording recording = record(result.cell->what, result.seed);
        if (!options_.folder.empty())
            write_file(options_.folder + "/" + result.cell->object->name + "_" +
                           result.cell->conditions + "_" + std::to_string(result.seed) + ".csv",
                       csv_of(recording));
        Answer answer[METHODS] = {ask_program(program_, recording), ask_skill(recording),
                                  ask_bic(recording)};
        for (int m = 0; m < METHODS; m++)
            result.of[m] = {score(recording, answer[m].estimate), answer[m].ms, answer[m].failed};
        return answer[OURS].failed && answer[OURS].failure == cannot_run
                   ? program_ + ": cannot be run; see --program"
                   : "";
    }

    const Options &options_;
    const std::vector<Cell> &cells_;
    std::string program_;
    size_t count_;
    std::vector<Result> results_;
    std::mutex mutex_; /* of wrong_ */
    std::string wrong_;
};

int fail(const std::string &what)
{
    (void)std::fprintf(stderr, "grrl-evaluate: %s\n", what.c_str());
    return EXIT_FAILED;
}

int report(const Options &options, const std::vector<Result> &results)
{
    print_table(stdout, results);
    bool good = write_outputs(
        "grrl-evaluate", options.csv, [&](std::FILE *file) { print_csv(file, results); },
        options.svg, [&] { return draw_svg(options.svg, results); });
    return good ? EXIT_FINE : EXIT_FAILED;
}

} // namespace

int study(int argc, char **argv)
{
    Options options;
    grrl_options_result parsed = parse_options(argc, argv, options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    grrl_sim::Result<std::vector<Cell>> cells = make_grid(options.grid);
    if (!cells) {
        (void)std::fprintf(stderr, "grrl-evaluate: --grid: %s\n", cells.error.c_str());
        return EXIT_USAGE;
    }
    try {
        if (!options.folder.empty())
            make_folder(options.folder);
        Study study(options, *cells.value);
        std::string wrong = study.run();
        return wrong.empty() ? report(options, study.results()) : fail(wrong);
    } catch (const std::runtime_error &error) {
        return fail(error.what());
    }
}

} // namespace grrl_experiment::recordings
