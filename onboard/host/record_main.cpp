/* grrl-record OBJECT TRIALS SEED POLICY RECORDING: runs the simulated world and the controller in
 * one process, and records the packets given to the controller. */
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "adapter.hpp"
#include "cli/options.h"
#include "controller.h"
#include "grrl/base/settling.h"
#include "supervisor.hpp"
#include "world.hpp"

using namespace grrl_sim;

namespace
{

constexpr int max_pushes = 100;

struct Run {
    std::FILE *file = nullptr;
    std::unique_ptr<onboard_controller> controller = std::make_unique<onboard_controller>();
    onboard_packet packet{};
    Frame frame;
    FrameArrays arrays;
    bool failed = false;
};

void write(Run &run)
{
    const onboard_packet &packet = run.packet;
    uint8_t head[3] = {packet.type, static_cast<uint8_t>(packet.n),
                       static_cast<uint8_t>(packet.n >> 8)};
    if (packet.bad || std::fwrite(head, 1, sizeof head, run.file) != sizeof head ||
        std::fwrite(packet.bytes, 1, packet.n, run.file) != packet.n)
        run.failed = true;
}

/* Whether the learner succeeded. */
bool send(Run &run)
{
    write(run);
    if (onboard_controller_take(run.controller.get(), &run.packet) != GRRL_OK)
        run.failed = true;
    return run.controller->answer.bytes[0] == 0;
}

bool send(Run &run, onboard_packet_type type, uint64_t value = 0, unsigned bytes = 0)
{
    onboard_packet_begin(&run.packet, static_cast<uint8_t>(type));
    onboard_put(&run.packet, value, bytes);
    return send(run);
}

/* Records the expected hashes so far, for the replay. */
void expect(Run &run)
{
    const onboard_hashes &hashes = run.controller->hashes;
    onboard_packet_begin(&run.packet, ONBOARD_EXPECT);
    for (uint64_t hash : {hashes.models, hashes.decisions, hashes.updates})
        onboard_put(&run.packet, hash, 8);
    write(run);
}

void open(Run &run, uint64_t seed, const char *policy)
{
    onboard_controller_init(run.controller.get(), nullptr);
    onboard_put_open(&run.packet, seed, policy);
    send(run);
}

void see(Run &run, World &world, bool pushing)
{
    world.observe(run.frame);
    grrl_frame frame = run.arrays.frame_of(run.frame);
    onboard_put_frame(&run.packet, &frame, pushing);
    send(run);
}

void settle(Run &run, World &world)
{
    for (int i = 0; i < GRRL_SETTLING_FRAMES; i++)
        see(run, world, false);
    send(run, ONBOARD_PERCEIVE);
}

/* Executes the push that the learner just decided. A refused push moves nothing. */
void push(Run &run, World &world)
{
    onboard_packet &answer = run.controller->answer;
    answer.at = 1; /* after the status */
    grrl_decision decision;
    if (!onboard_get_decision(&answer, &decision))
        run.failed = true;
    if (!world.begin_push(command_of(decision.push)).empty())
        return;
    bool moving = true;
    while (moving) {
        moving = world.step_frame();
        see(run, world, true);
    }
}

int trial(Run &run, const ObjectSpec &object, uint64_t seed, int32_t number)
{
    World world(object, WorldParams{}, trial_seed(seed, number));
    Supervisor supervisor(object.truth);
    send(run, ONBOARD_TRIAL, static_cast<uint64_t>(number), 4);
    settle(run, world);
    int pushes = 0;
    bool found = false;
    while (!run.failed && !found && pushes < max_pushes) {
        if (!send(run, ONBOARD_CHOOSE))
            break; /* no link to push */
        push(run, world);
        pushes++;
        settle(run, world);
        grrl_graph estimated;
        const grrl_learner &learner = run.controller->learner;
        grrl_relational_state_of(grrl_perception_model(&learner.perception), learner.config.large_m,
                                 &estimated, nullptr, nullptr);
        found = supervisor.judge(estimated).correct;
        send(run, ONBOARD_LEARN, found ? 1 : 0, 1);
        expect(run);
    }
    return pushes;
}

const grrl_program program = {
    "grrl-record",
    "grrl-record OBJECT TRIALS SEED learn|paper RECORDING",
    "Runs the simulated world and the controller in one process, and writes the packets that the\n"
    "controller was given; grrl-replay and the images in onboard/ read them.\n",
    "Exit status: 0 success; 1 failure; 2 wrong command line.\n",
    5,
    "expected OBJECT TRIALS SEED POLICY RECORDING",
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
    const std::string policy = arguments[3];
    const char *path = arguments[4];
    if (!grrl_option_integer_of(arguments[1], 1, 1000000, &trials))
        return grrl_options_wrong(&program, "TRIALS must be a number from 1 to 1000000");
    if (!grrl_option_integer_of(arguments[2], 0, UINT64_MAX, &seed))
        return grrl_options_wrong(&program, "SEED must be a number from 0");
    if (policy != "learn" && policy != "paper")
        return grrl_options_wrong(&program, "POLICY must be learn or paper");
    Result<ObjectSpec> object = object_from_text(arguments[0]);
    Run run;
    if (object)
        run.file = std::fopen(path, "wb");
    if (run.file == nullptr) {
        std::string why = object ? std::string(path) + ": cannot be written" : object.error;
        (void)std::fprintf(stderr, "grrl-record: %s\n", why.c_str());
        return 1;
    }
    open(run, seed, policy.c_str());
    (void)std::printf("pushes");
    for (int32_t i = 1; i <= static_cast<int32_t>(trials) && !run.failed; i++)
        (void)std::printf(" %d", trial(run, *object.value, seed, i));
    (void)std::printf("\n");
    if (!send(run, ONBOARD_CLOSE) || std::fclose(run.file) != 0 || run.failed) {
        (void)std::fprintf(stderr, "grrl-record: %s is not complete\n", path);
        return 1;
    }
    return 0;
}
