/* progress.hpp: a bar with the time left on a terminal, a line now and then elsewhere. */
#ifndef GRRL_EXPERIMENT_PROGRESS_HPP
#define GRRL_EXPERIMENT_PROGRESS_HPP

#include <chrono>
#include <cstdint>
#include <string>

namespace grrl_experiment
{

class Progress
{
public:
    /* Trials to be done in all, in so many parts ("experiments"). */
    Progress(int64_t trials, int64_t parts, const char *name_of_parts);

    void trial(int pushes);
    void part() { parts_done_++; }
    void show();   /* if it is time to */
    void finish(); /* the last state, and the line is over */

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

} // namespace grrl_experiment

#endif
