/*
 * sides.hpp: the two ends of the wire, in one process or in two.
 *
 * Each uses LCM on an lcm_t of the caller. Call lcm_handle and tick alternately until finished.
 */
#ifndef GRRL_EXPERIMENT_SIDES_HPP
#define GRRL_EXPERIMENT_SIDES_HPP

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <set>
#include <tuple>
#include <vector>

#include "agent.h"
#include "node.hpp"
#include "policies.hpp"

namespace grrl_experiment
{

using Bytes = std::vector<uint8_t>; /* as grrl_learner_save writes them */
using PolicyMemory = std::vector<std::max_align_t>;
using Clock = std::function<int64_t()>;

struct TrialRow {
    int trial = 0; /* from 1 */
    int pushes = 0;
    bool discovered = false; /* else capped */
    int wrong_joints = 0;    /* wrong joints ever estimated in the trial */
};

/* The object of a trial, counted from 1, in a run with this seed. */
using Objects = std::function<grrl_sim::ObjectSpec(uint64_t seed, int32_t trial)>;

/* A number of trials without a break. */
struct Phase {
    Objects objects;
    const Policy *policy = nullptr;
    int trials = 1;
    int cap = 100;
    uint64_t seed = 1;
    grrl_sim::WorldParams world; /* the agent knows the noise of a tracked point */
};

/* Why a policy cannot continue from this experience, or an empty text. */
std::string objection(const Policy &policy, const Bytes &experience);

/* The agent's core and its policy. */
class AgentSide
{
public:
    /* node: as for Policy. Throws std::runtime_error if LCM fails or the experience is invalid. */
    AgentSide(lcm_t *lcm, const Phase &phase, Clock clock, const grrl_sim::Node *node,
              const Bytes &experience);
    ~AgentSide();
    AgentSide(const AgentSide &) = delete;
    AgentSide &operator=(const AgentSide &) = delete;

    void tick() { grrl_agent_tick(agent_.get()); }
    bool finished() const { return grrl_agent_finished(agent_.get()); }
    Bytes experience() const;

private:
    static int64_t now_us(void *context);

    Clock clock_;
    std::unique_ptr<Chooser> chooser_;
    bool learns_;
    PolicyMemory memory_;
    std::unique_ptr<grrl_agent> agent_;
};

/* The simulator node; also counts wrong joints in the models it receives. */
class WorldSide
{
public:
    using OnTrial = std::function<void(const TrialRow &)>;

    WorldSide(lcm_t *lcm, const Phase &phase, Clock clock, OnTrial on_trial);

    /* Throws std::runtime_error if the run cannot continue. */
    void tick();
    bool finished() const { return node_->finished(); }
    int64_t agent_silent_us() const { return node_->agent_silent_us(); }
    const grrl_sim::Node &node() const { return *node_; }

private:
    void on_message(const char *channel, const void *data, uint32_t size);
    void on_trial(const grrl_sim::TrialResult &result);

    OnTrial on_trial_;
    int trials_ = 0;
    int32_t trial_id_ = 0;
    int32_t cmd_seq_ = -1;                      /* of the latest model measured */
    std::set<std::tuple<int, int, int>> wrong_; /* numbers of the links, type */
    std::unique_ptr<grrl_wire_model> model_;
    std::unique_ptr<grrl_sim::Node> node_;
};

} // namespace grrl_experiment

#endif
