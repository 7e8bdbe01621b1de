/* progress.cpp: shows a run's progress on standard error. */
#include "progress.hpp"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <thread>
#include <vector>

#include <unistd.h>

namespace grrl_experiment
{

namespace
{

constexpr double terminal_every_s = 0.3;
constexpr double lines_every_s = 10.0;
constexpr int bar_width = 24;

bool is_terminal()
{
    const char *term = std::getenv("TERM");
    return isatty(STDERR_FILENO) == 1 && term != nullptr && std::strcmp(term, "dumb") != 0;
}

} // namespace

Progress::Progress(int64_t trials, int64_t parts, const char *name_of_parts)
    : trials_(trials), parts_(parts), name_of_parts_(name_of_parts), terminal_(is_terminal()),
      start_(std::chrono::steady_clock::now())
{
}

void Progress::trial(int pushes)
{
    trials_done_++;
    pushes_ += pushes;
}

double Progress::elapsed_s() const
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

std::string Progress::line() const
{
    double share =
        trials_ > 0 ? static_cast<double>(trials_done_) / static_cast<double>(trials_) : 1.0;
    std::string bar(static_cast<size_t>(std::min(share, 1.0) * bar_width), '#');
    bar.resize(bar_width, '.');
    double elapsed = elapsed_s();
    char left[40] = "?";
    if (trials_done_ > 0) {
        long seconds = static_cast<long>(elapsed * (1.0 - share) / share + 0.5);
        (void)std::snprintf(left, sizeof left, "%ld:%02ld", seconds / 60, seconds % 60);
    }
    char text[160];
    (void)std::snprintf(text, sizeof text, "[%s] %3.0f%%  %lld of %lld %s, %s left", bar.c_str(),
                        100.0 * share, static_cast<long long>(parts_done_),
                        static_cast<long long>(parts_), name_of_parts_, left);
    char rate[40] = "";
    if (pushes_ > 0)
        (void)std::snprintf(rate, sizeof rate, ", %.0f pushes/s",
                            static_cast<double>(pushes_) / std::max(elapsed, 0.001));
    return std::string(text) + rate;
}

void Progress::print()
{
    shown_s_ = elapsed_s();
    (void)std::fprintf(stderr, terminal_ ? "\r%s\033[K" : "%s\n", line().c_str());
    (void)std::fflush(stderr);
}

void Progress::show()
{
    if (elapsed_s() - shown_s_ >= (terminal_ ? terminal_every_s : lines_every_s))
        print();
}

void Progress::finish()
{
    print();
    if (terminal_)
        (void)std::fputc('\n', stderr);
}

void run_parallel(size_t n, int jobs, bool quiet, const char *name_of_parts,
                  const std::function<int(size_t)> &one)
{
    Progress progress(static_cast<int64_t>(n), static_cast<int64_t>(n), name_of_parts);
    std::mutex mutex; /* of progress */
    std::atomic<size_t> next{0};
    auto work = [&] {
        for (size_t i = next++; i < n; i = next++) {
            int pushes = one(i);
            std::lock_guard<std::mutex> lock(mutex);
            if (pushes < 0)
                next = n;
            progress.trial(std::max(pushes, 0));
            progress.part();
            if (!quiet)
                progress.show();
        }
    };
    std::vector<std::thread> threads;
    for (int i = 1; i < jobs; i++)
        threads.emplace_back(work);
    work();
    for (std::thread &thread : threads)
        thread.join();
    if (!quiet)
        progress.finish();
}

} // namespace grrl_experiment
