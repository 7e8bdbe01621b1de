/* progress.hpp: on a terminal a progress bar with the remaining time, elsewhere an
 * occasional line. */
#ifndef GRRL_EXPERIMENT_PROGRESS_HPP
#define GRRL_EXPERIMENT_PROGRESS_HPP

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace grrl_experiment
{

class Progress
{
public:
    /* The total number of trials, and of the parts they form ("experiments"). */
    Progress(int64_t trials, int64_t parts, const char *name_of_parts);

    void trial(int pushes);
    void part() { parts_done_++; }
    void show();   /* if it is due */
    void finish(); /* shows the final state and ends the line */

    int64_t pushes() const { return pushes_; }
    double elapsed_s() const;

private:
    std::string line() const;
    void print();

    int64_t trials_;
    int64_t parts_;
    const char *name_of_parts_;
    int64_t trials_done_ = 0;
    int64_t parts_done_ = 0;
    int64_t pushes_ = 0;
    bool terminal_;
    double shown_s_ = 0.0;
    std::chrono::steady_clock::time_point start_;
};

/* Calls one(i) for each i below n, in as many threads as there are jobs, and shows progress unless
 * quiet. `one` returns the pushes to count, or -1 to stop before further calls. */
void run_parallel(size_t n, int jobs, bool quiet, const char *name_of_parts,
                  const std::function<int(size_t)> &one);

} // namespace grrl_experiment

#endif
