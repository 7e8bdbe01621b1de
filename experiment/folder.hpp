/*
 * folder.hpp: the results folder, from which an interrupted run resumes.
 *
 * settings.txt lists everything the results depend on: this program's bytes, objects, policies,
 * seed, .. but not the number of experiments or jobs, nor the transport. experiments/ has one file
 * for each finished experiment.
 */
#ifndef GRRL_EXPERIMENT_FOLDER_HPP
#define GRRL_EXPERIMENT_FOLDER_HPP

#include <optional>
#include <string>

#include "options.hpp"
#include "plan.hpp"
#include "statistics.hpp"

namespace grrl_experiment
{

class Folder
{
public:
    /* Throws std::runtime_error if the folder cannot be written, another run uses it, or it holds
     * results with other settings. */
    Folder(const Options &options, const Plan &plan);
    ~Folder();
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;

    std::string path(const std::string &name) const { return root_ + "/" + name; }

    /* Returns nullopt if the experiment is not finished. Experiments count from 1. */
    std::optional<Trials> load(size_t curve, int experiment) const;
    void save(size_t curve, int experiment, const Trials &trials) const;

private:
    std::string experiment_path(size_t curve, int experiment) const;
    void lock();
    void check_settings(const std::string &settings) const;

    std::string root_;
    std::vector<int> trials_; /* of each curve */
    int lock_fd_ = -1;
};

} // namespace grrl_experiment

#endif
