/* until_sure OBJECT RUNS P PUSHES: how often a run without a supervisor ends sure, and how often it
 * is right then; also at the first model in which all pairs are decided. The table of
 * docs/robot.md. */
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "agent.h"
#include "own_plant.hpp"
#include "policy_memory.h"

namespace
{

constexpr uint32_t capacity = 500;
constexpr int64_t frame_us = 33333;

int64_t clock_us;

/* One run, and what both ways of ending came to. */
struct Ending {
    int n = 0;
    int right = 0;
    int pushes = 0;

    void add(bool is_right, int after)
    {
        n++;
        right += is_right;
        pushes += after;
    }
    double mean() const { return n > 0 ? static_cast<double>(pushes) / n : 0.0; }
};

struct Watch {
    const grrl_agent *agent;
    float wanted;
    grrl_sim::ObjectSpec truth;
    bool decided;
    bool right; /* the newest model */
    Ending first;
};

/* Links and joints of each type, as many as there are: enough for the chains of the table. */
bool is_right(const grrl_model &model, const grrl_sim::ObjectSpec &truth)
{
    int slides = 0;
    for (int i = 0; i < model.n_joints; i++)
        slides += model.joint[i].type == GRRL_PRISMATIC;
    for (const grrl_sim::JointSpec &joint : truth.joints)
        slides -= joint.type == GRRL_PRISMATIC;
    return model.n_bodies == truth.links.size() && model.n_joints == truth.joints.size() &&
           slides == 0;
}

void on_event(void *context, const grrl_agent_event *event)
{
    auto *watch = static_cast<Watch *>(context);
    if (event->kind != GRRL_AGENT_PERCEIVED)
        return;
    watch->right =
        is_right(*grrl_perception_model(&watch->agent->learner.perception), watch->truth);
    uint8_t a, b;
    if (watch->decided || grrl_agent_sureness(watch->agent, &a, &b) < watch->wanted)
        return;
    watch->decided = true;
    watch->first.add(watch->right, event->pushes);
}

bool run_on(lcm_t *lcm, Watch &watch, const char *object, uint64_t seed, int pushes, Ending &sure)
{
    static POLICY_MEMORY(capacity) memory;
    auto agent = std::make_unique<grrl_agent>();
    grrl_agent_config config{};
    grrl_learner_config_default(&config.learner);
    config.learner.seed = seed;
    config.session_id = 1;
    config.max_pushes = pushes;
    config.until_sure = watch.wanted;
    config.pair = grrl_perception_pair;
    config.now_us = [](void *) { return clock_us; };
    config.on_event = on_event;
    config.context = &watch;
    watch.agent = agent.get();
    watch.decided = false;
    if (grrl_policy_make(&grrl_policy_learn, memory.bytes, sizeof memory.bytes, capacity, nullptr,
                         &config.policy) != GRRL_OK ||
        grrl_agent_init(agent.get(), &config, lcm) != GRRL_OK)
        return false;
    OwnPlant plant(lcm, object, seed);
    while (grrl_agent_end(agent.get()) == GRRL_AGENT_GOES_ON) {
        plant.frame(clock_us += frame_us);
        while (lcm_handle_timeout(lcm, 0) > 0)
            continue;
    }
    if (grrl_agent_end(agent.get()) == GRRL_AGENT_SURE)
        sure.add(watch.right, plant.pushes());
    grrl_agent_close(agent.get());
    return plant.orderly();
}

bool run(Watch &watch, const char *object, uint64_t seed, int pushes, Ending &sure)
{
    lcm_t *lcm = lcm_create("memq://");
    if (lcm == nullptr)
        return false;
    bool good = run_on(lcm, watch, object, seed, pushes, sure);
    lcm_destroy(lcm);
    return good;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc != 5)
        return 2;
    auto object = grrl_sim::object_from_text(argv[1]);
    if (!object)
        return 2;
    Watch watch{nullptr, static_cast<float>(std::atof(argv[3])), *object.value, false, false, {}};
    Ending sure;
    for (int seed = 1; seed <= std::atoi(argv[2]); seed++)
        if (!run(watch, argv[1], static_cast<uint64_t>(seed), std::atoi(argv[4]), sure))
            return 1;
    (void)std::printf("| %s | %d | %d | %.1f | %d of %d, %.1f pushes |\n", argv[1], sure.n,
                      sure.right, sure.mean(), watch.first.right, watch.first.n,
                      watch.first.mean());
    return 0;
}
