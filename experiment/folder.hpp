/*
 * folder.hpp: the results folder, from which an interrupted run resumes.
 *
 * settings.txt lists what all results depend on: this program's bytes, the cap, the noise; not the
 * number of jobs, nor the transport. experiments/ has one file for each finished experiment; its
 * name depends on everything else: policy, objects, trials, seed. So further policies, objects and
 * seeds may join a folder.
 */
#ifndef GRRL_EXPERIMENT_FOLDER_HPP
#define GRRL_EXPERIMENT_FOLDER_HPP

#include <optional>
#include <string>
#include <vector>

#include "options.hpp"
#include "plan.hpp"
#include "statistics.hpp"

namespace grrl_experiment
{

constexpr const char *settings_file = "settings.txt";
constexpr const char *arguments_file = "arguments.txt"; /* shared_arguments of the last command */

class Folder
{
public:
    /* Throws std::runtime_error if the folder cannot be written, another run uses it, or it holds
     * results with other settings. */
    explicit Folder(const Options &options);
    ~Folder();
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;

    std::string path(const std::string &name) const { return root_ + "/" + name; }

    /* Returns nullopt if the experiment with this seed is not finished. */
    std::optional<Trials> load(const Curve &curve, uint64_t seed) const;
    void save(const Curve &curve, uint64_t seed, const Trials &trials) const;

    /* Keeps what a policy knew in the end, in a file that grrl-agent --store takes. */
    void save_store(const Curve &curve, uint64_t seed, const std::vector<uint8_t> &bytes) const;

    /* Copies the experiments of another folder. Throws if it was made with other settings. */
    void take(const std::string &other) const;

private:
    std::string experiment_path(const Curve &curve, uint64_t seed) const;
    void lock();
    void check_settings(const std::string &settings) const;

    std::string root_;
    int lock_fd_ = -1;
};

} // namespace grrl_experiment

#endif
