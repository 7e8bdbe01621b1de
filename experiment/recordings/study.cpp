/* study.cpp: all recordings of a grid, by all methods, in several threads. */
#include "study.hpp"

#include <atomic>
#include <cerrno>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <thread>

#include <unistd.h>

#include "files.hpp"
#include "progress.hpp"

namespace grrl_experiment::recordings
{

namespace
{

enum { EXIT_FINE = 0, EXIT_FAILED = 1, EXIT_USAGE = 2 };

/* grrl-perceive where it is installed or built, or the one in $PATH. */
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

    /* Empty, or what went wrong. */
    std::string run()
    {
        auto all = static_cast<int64_t>(results_.size());
        Progress progress(all, all, "recordings");
        auto work = [&] {
            for (size_t i = next_++; i < results_.size(); i = next_++) {
                std::string wrong = try_one(i);
                std::lock_guard<std::mutex> lock(mutex_);
                if (!wrong.empty()) {
                    wrong_ = wrong;
                    next_ = results_.size();
                }
                progress.trial(0);
                progress.part();
                if (!options_.quiet)
                    progress.show();
            }
        };
        std::vector<std::thread> threads;
        for (int i = 1; i < options_.jobs; i++)
            threads.emplace_back(work);
        work();
        for (std::thread &thread : threads)
            thread.join();
        if (!options_.quiet)
            progress.finish();
        return wrong_;
    }

    const std::vector<Result> &results() const { return results_; }

private:
    std::string try_one(size_t i)
    {
        try {
            return one(i);
        } catch (const std::runtime_error &error) { /* a file */
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
    std::atomic<size_t> next_{0};
    std::mutex mutex_; /* of progress and wrong_ */
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
    if (!options.csv.empty()) {
        std::FILE *file = std::fopen(options.csv.c_str(), "w");
        if (file != nullptr)
            print_csv(file, results);
        bool good = file != nullptr && std::ferror(file) == 0;
        if (file == nullptr || std::fclose(file) != 0 || !good)
            return fail(options.csv + ": " + std::strerror(errno));
    }
    if (!options.svg.empty() && !draw_svg(options.svg, results))
        return fail(options.svg +
                    ": gnuplot failed; is it installed, and can the file be written?");
    return EXIT_FINE;
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
