/* grrl-feed SOCKET OBJECT TRIALS SEED: the host of the example firmware. Its simulated world sends
 * points on the line and makes the pushes that come back; a learner of its own must decide the
 * same. */
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "adapter.hpp"
#include "cli/options.h"
#include "grrl/base/settling.h"
#include "grrl/learner/cases/learn_policy.h"
#include "grrl/policies.h"
#include "link.h"
#include "supervisor.hpp"
#include "world.hpp"

using namespace grrl_sim;

namespace
{

constexpr int max_pushes = 100;
constexpr int patience_ms = 600000; /* an emulated line on a busy machine is slow */

struct Host {
    int fd = -1;
    grrl_learner learner;
    alignas(max_align_t) unsigned char memory[GRRL_LEARN_POLICY_BYTES(ONBOARD_ENTRIES)];
    onboard_packet in{};
    onboard_packet out{};
    onboard_receiver receiver{};
    FrameArrays arrays;
    Frame frame;
    uint64_t bytes = 0;
    int decisions = 0; /* the same on both sides */
    std::string why;   /* what went wrong */
};

Host host;

bool connect_to(const char *path)
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    if (std::strlen(path) >= sizeof address.sun_path)
        return false;
    std::strcpy(address.sun_path, path);
    for (int i = 0; i < 250; i++) { /* five seconds: the emulator is on its way */
        host.fd = socket(AF_UNIX, SOCK_STREAM, 0);
        if (connect(host.fd, reinterpret_cast<sockaddr *>(&address), sizeof address) == 0)
            return true;
        (void)close(host.fd);
        (void)usleep(20000);
    }
    return false;
}

void send()
{
    uint8_t line[ONBOARD_LINK_BYTES];
    size_t n = onboard_link_encode(0, host.out.type, host.out.bytes, host.out.n, line);
    host.bytes += n;
    for (size_t at = 0; at < n && host.why.empty();) {
        ssize_t sent = write(host.fd, line + at, n - at);
        if (sent <= 0)
            host.why = std::string("the line is gone: ") + std::strerror(errno);
        else
            at += static_cast<size_t>(sent);
    }
}

/* Waits for the firmware's decision; host.in holds it. */
bool receive()
{
    pollfd waiting = {host.fd, POLLIN, 0};
    uint8_t byte = 0;
    while (poll(&waiting, 1, patience_ms) > 0 && read(host.fd, &byte, 1) == 1) {
        onboard_link_event event = onboard_link_take(&host.receiver, byte);
        if (event == ONBOARD_LINK_DAMAGED)
            return false;
        if (event == ONBOARD_LINK_FRAME)
            return host.in.type == ONBOARD_DECISION;
    }
    return false;
}

bool begin()
{
    grrl_policy policy;
    grrl_learner_config config;
    grrl_learner_config_default(&config);
    onboard_link_init(&host.receiver, &host.in);
    return grrl_policy_make(&grrl_policy_learn, host.memory, sizeof host.memory, ONBOARD_ENTRIES,
                            nullptr, &policy) == GRRL_OK &&
           grrl_learner_init(&host.learner, &config, policy) == GRRL_OK;
}

void see(World &world, bool moving)
{
    world.observe(host.frame);
    grrl_frame frame = host.arrays.frame_of(host.frame);
    grrl_learner_observe(&host.learner, &frame, moving);
    onboard_put_frame(&host.out, &frame, moving);
    send();
}

/* Ten frames at rest; then both learners decide. False: nothing to push, or they differ. */
bool decide(World &world, bool pushed, grrl_decision &decision)
{
    grrl_update update;
    for (int i = 0; i < GRRL_SETTLING_FRAMES; i++)
        see(world, false);
    if (grrl_learner_perceive(&host.learner) != GRRL_OK ||
        (pushed && grrl_learner_learn(&host.learner, false, &update) != GRRL_OK) ||
        grrl_learner_choose(&host.learner, &decision) != GRRL_OK)
        return false;
    onboard_packet_begin(&host.out, ONBOARD_DECISION);
    onboard_put_decision(&host.out, &decision);
    if (!receive())
        host.why = "no decision came";
    else if (host.in.n != host.out.n || std::memcmp(host.in.bytes, host.out.bytes, host.in.n) != 0)
        host.why = "the firmware decides otherwise";
    else
        host.decisions++;
    return host.why.empty();
}

/* Returns the number of pushes. */
int trial(const ObjectSpec &object, uint64_t seed, int32_t number)
{
    World world(object, WorldParams{}, trial_seed(seed, number));
    Supervisor supervisor(object.truth);
    grrl_learner_begin_trial(&host.learner, static_cast<uint32_t>(number));
    onboard_packet_begin(&host.out, ONBOARD_TRIAL);
    onboard_put(&host.out, static_cast<uint64_t>(number), 4);
    send();
    int pushes = 0;
    grrl_decision decision;
    while (pushes < max_pushes && decide(world, pushes > 0, decision)) {
        grrl_graph estimated;
        grrl_relational_state_of(grrl_perception_model(&host.learner.perception),
                                 host.learner.config.large_m, &estimated, nullptr, nullptr);
        if (supervisor.judge(estimated).correct)
            break; /* the push just decided is not made */
        pushes++;
        if (!world.begin_push(command_of(decision.push)).empty())
            continue;
        bool moving = true;
        while (moving && host.why.empty()) {
            moving = world.step_frame();
            see(world, true);
        }
    }
    return pushes;
}

const grrl_program program = {
    "grrl-feed",
    "grrl-feed SOCKET OBJECT TRIALS SEED",
    "Plays tracker and robot for the example firmware behind a Unix socket, and checks each of "
    "its\n"
    "decisions against a learner of its own.\n",
    "Exit status: 0 all decisions are the same; 1 they differ, or the line is gone; 2 wrong "
    "command\n"
    "line.\n",
    4,
    "expected SOCKET OBJECT TRIALS SEED",
};

} // namespace

int main(int argc, char **argv)
{
    int first = 0;
    grrl_options_result parsed = grrl_options_parse(&program, nullptr, 0, argc, argv, &first);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    if (argc - first != program.max_arguments)
        return grrl_options_wrong(&program, program.arguments);
    char **arguments = argv + first;
    uint64_t trials = 0;
    uint64_t seed = 0;
    if (!grrl_option_integer_of(arguments[2], 1, 1000000, &trials))
        return grrl_options_wrong(&program, "TRIALS must be a number from 1 to 1000000");
    if (!grrl_option_integer_of(arguments[3], 0, UINT64_MAX, &seed))
        return grrl_options_wrong(&program, "SEED must be a number from 0");
    Result<ObjectSpec> object = object_from_text(arguments[1]);
    if (!object || !connect_to(arguments[0])) {
        std::string why = object ? std::string(arguments[0]) + ": no firmware there" : object.error;
        (void)std::fprintf(stderr, "grrl-feed: %s\n", why.c_str());
        return 1;
    }
    if (!begin())
        host.why = "the learner does not begin";
    (void)std::printf("pushes");
    for (int32_t i = 1; i <= static_cast<int32_t>(trials) && host.why.empty(); i++)
        (void)std::printf(" %d", trial(*object.value, seed, i));
    (void)std::printf("\ndecisions %d, bytes sent %llu\n", host.decisions,
                      static_cast<unsigned long long>(host.bytes));
    if (!host.why.empty())
        (void)std::fprintf(stderr, "grrl-feed: %s\n", host.why.c_str());
    return host.why.empty() ? 0 : 1;
}
