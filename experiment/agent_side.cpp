/* agent_side.cpp: the agent's core with its policy's memory. */
#include <algorithm>
#include <cstring>
#include <stdexcept>

#include "sides.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int64_t agent_session = 4711;
constexpr float least_noise_m =
    0.00005f; /* lower limit of the assumed noise: no camera is perfect */

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

/* A policy of the library. */
grrl_policy make_policy(const Policy &policy, PolicyMemory &memory, grrl_learner_config &learner)
{
    alignas(std::max_align_t) unsigned char config[GRRL_POLICY_CONFIG_BYTES];
    if (policy.type->config_default != nullptr)
        policy.type->config_default(config);
    if (policy.configure)
        policy.configure(learner, config);
    size_t bytes = policy.type->bytes(policy.capacity);
    memory.resize(bytes / sizeof(std::max_align_t) + 1);
    grrl_policy made{};
    must(grrl_policy_make(policy.type, memory.data(), bytes, policy.capacity,
                          policy.type->config_default != nullptr ? config : nullptr, &made),
         "the policy cannot start");
    return made;
}

grrl_status load(grrl_learner &learner, const Bytes &experience)
{
    Reader reader{&experience, 0};
    grrl_io io{};
    io.context = &reader;
    io.read = read_bytes;
    grrl_status status = grrl_learner_load(&learner, &io);
    return status == GRRL_OK && reader.at < experience.size() ? GRRL_ERR_FORMAT : status;
}

} // namespace

std::string objection(const Policy &policy, const Bytes &experience)
{
    auto learner = std::make_unique<grrl_learner>();
    PolicyMemory memory;
    grrl_learner_config config{};
    grrl_learner_config_default(&config);
    grrl_policy made = make_policy(policy, memory, config);
    must(grrl_learner_init(learner.get(), &config, made), "the learner cannot start");
    grrl_status status = load(*learner, experience);
    if (status == GRRL_ERR_IO)
        return "it ends early";
    return status == GRRL_OK ? "" : grrl_status_text(status);
}

int64_t AgentSide::now_us(void *context)
{
    return static_cast<AgentSide *>(context)->clock_();
}

AgentSide::AgentSide(lcm_t *lcm, const Phase &phase, Clock clock, const grrl_sim::Node *node,
                     const Bytes &experience)
    : clock_(std::move(clock)), learns_(phase.policy->learns()),
      agent_(std::make_unique<grrl_agent>())
{
    grrl_agent_config config{};
    grrl_learner_config_default(&config.learner);
    if (phase.policy->make_chooser) {
        chooser_ = phase.policy->make_chooser(node, phase.seed);
        config.policy = policy_of(*chooser_);
    } else {
        config.policy = make_policy(*phase.policy, memory_, config.learner);
    }
    config.learner.seed = phase.seed;
    config.learner.perception.noise_m =
        std::max(least_noise_m, static_cast<float>(phase.world.tracker.noise_sigma_m));
    config.session_id = agent_session;
    config.now_us = now_us;
    config.context = this;
    must(grrl_agent_init(agent_.get(), &config, lcm), "the agent cannot start");
    if (!experience.empty())
        must(load(agent_->learner, experience), "cannot load the experience");
}

AgentSide::~AgentSide()
{
    grrl_agent_close(agent_.get());
}

Bytes AgentSide::experience() const
{
    Bytes bytes;
    if (!learns_)
        return bytes;
    grrl_io io{};
    io.context = &bytes;
    io.write = append_bytes;
    must(grrl_learner_save(&agent_->learner, &io), "cannot save the experience");
    return bytes;
}

} // namespace grrl_experiment
