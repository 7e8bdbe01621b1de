/* world_side.cpp: the simulator of an experiment, which also counts wrong joints in models. */
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "sides.hpp"
#include "truth.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int64_t world_session = 815;

} // namespace

WorldSide::WorldSide(lcm_t *lcm, const Phase &phase, Clock clock, OnTrial on_trial)
    : on_trial_(std::move(on_trial)), model_(std::make_unique<grrl_wire_model>())
{
    grrl_sim::NodeConfig config;
    config.next_object = [objects = phase.objects, seed = phase.seed](int32_t trial) {
        return objects(seed, trial);
    };
    config.world = phase.world;
    config.seed = phase.seed;
    config.trials = phase.trials;
    config.cap = phase.cap;
    config.session_id = world_session;
    config.now_us = std::move(clock);
    config.on_trial = [this](const grrl_sim::TrialResult &result) { this->on_trial(result); };
    config.on_message = [this](const char *channel, const void *data, uint32_t size) {
        on_message(channel, data, size);
    };
    node_ = std::make_unique<grrl_sim::Node>(lcm, std::move(config));
}

void WorldSide::tick()
{
    node_->tick();
    if (node_->agent_has_nothing_to_push())
        throw std::runtime_error("the agent finds nothing to push; try a lower --noise");
}

void WorldSide::on_message(const char *channel, const void *data, uint32_t size)
{
    grrl_wire_why why;
    if (std::strcmp(channel, GRRL_CHANNEL_MODEL) != 0 ||
        !grrl_wire_decode_model(data, size, model_.get(), &why))
        return;
    const grrl_model_t &model = model_->message;
    if (model.trial_id != trial_id_) {
        if (model.trial_id < trial_id_)
            return; /* a late repetition */
        trial_id_ = model.trial_id;
        cmd_seq_ = -1;
        wrong_.clear();
    }
    if (model.cmd_seq <= cmd_seq_)
        return;
    cmd_seq_ = model.cmd_seq;
    Estimate estimate = estimate_of(model);
    std::vector<bool> wrong = wrong_joints(node_->world(), estimate);
    for (size_t i = 0; i < wrong.size(); i++) {
        const EstimatedJoint &joint = estimate.joints[i];
        auto ends = std::minmax(model.link_number[joint.a], model.link_number[joint.b]);
        if (wrong[i])
            wrong_.insert({ends.first, ends.second, joint.type});
    }
}

void WorldSide::on_trial(const grrl_sim::TrialResult &result)
{
    if (result.outcome == GRRL_TRIAL_T_ABORTED)
        return;
    TrialRow row;
    row.trial = ++trials_;
    row.pushes = result.pushes;
    row.discovered = result.outcome == GRRL_TRIAL_T_DISCOVERED;
    row.wrong_joints = static_cast<int>(wrong_.size());
    on_trial_(row);
}

} // namespace grrl_experiment
