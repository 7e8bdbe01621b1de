#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "sides.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int64_t agent_session = 4711;
constexpr float least_noise_m = 0.00005f; /* to assume: no camera has none */

struct Reader {
    const Bytes *bytes;
    size_t at;
};

int read_bytes(void *context, void *to, size_t size)
{
    Reader *reader = static_cast<Reader *>(context);
    if (size > reader->bytes->size() - reader->at)
        return -1;
    std::memcpy(to, reader->bytes->data() + reader->at, size);
    reader->at += size;
    return 0;
}

int append_bytes(void *context, const void *from, size_t size)
{
    Bytes *to = static_cast<Bytes *>(context);
    const uint8_t *bytes = static_cast<const uint8_t *>(from);
    to->insert(to->end(), bytes, bytes + size);
    return 0;
}

void must(grrl_status status, const char *what)
{
    if (status != GRRL_OK)
        throw std::runtime_error(std::string(what) + ": " + grrl_status_text(status));
}

} // namespace

int64_t AgentSide::now_us(void *context)
{
    return static_cast<AgentSide *>(context)->clock_();
}

void AgentSide::on_event(void *context, const grrl_agent_event *event)
{
    AgentSide *side = static_cast<AgentSide *>(context);
    if (event->kind == GRRL_AGENT_TRIAL_END && side->chooser_ != nullptr)
        side->chooser_->begin_trial();
}

grrl_status AgentSide::choose(void *context, grrl_learner *learner, grrl_decision *decision)
{
    AgentSide *side = static_cast<AgentSide *>(context);
    const grrl_model *model = grrl_perception_model(&learner->perception);
    if (model->n_bodies == 0)
        return GRRL_ERR_NONE;
    side->chooser_->look(learner->perception);
    Action action = side->chooser_->choose(*model);
    return grrl_learner_adopt(learner, action.body_number, action.direction, decision);
}

AgentSide::AgentSide(lcm_t *lcm, const Phase &phase, Clock clock, const grrl_sim::Node *node,
                     const Bytes &experience)
    : clock_(std::move(clock)), cases_(phase.policy->capacity), states_(phase.policy->capacity),
      experiences_(phase.policy->capacity), agent_(std::make_unique<grrl_agent>())
{
    const Policy &policy = *phase.policy;
    if (policy.make_chooser != nullptr)
        chooser_ = policy.make_chooser(node, phase.seed);
    grrl_agent_config config{};
    grrl_learner_config_default(&config.learner);
    policy.configure(config.learner);
    config.learner.seed = phase.seed;
    config.learner.perception.noise_m = std::max(least_noise_m, static_cast<float>(phase.noise_m));
    config.session_id = agent_session;
    config.now_us = now_us;
    config.on_event = on_event;
    config.choose = chooser_ != nullptr ? choose : nullptr;
    config.context = this;
    config.memory = {cases_.data(),   policy.capacity,     states_.data(),
                     policy.capacity, experiences_.data(), policy.capacity};
    must(grrl_agent_init(agent_.get(), &config, lcm), "the agent does not start");
    if (experience.empty())
        return;
    Reader reader{&experience, 0};
    grrl_io io{};
    io.context = &reader;
    io.read = read_bytes;
    must(grrl_learner_load(&agent_->learner, &io), "the experience does not load");
}

AgentSide::~AgentSide()
{
    grrl_agent_close(agent_.get());
}

Bytes AgentSide::experience() const
{
    Bytes bytes;
    grrl_io io{};
    io.context = &bytes;
    io.write = append_bytes;
    must(grrl_learner_save(&agent_->learner, &io), "the experience does not save");
    return bytes;
}

} // namespace grrl_experiment
