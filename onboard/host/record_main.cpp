/* grrl-record OBJECT TRIALS SEED POLICY RECORDING: a run of the simulated world and the controller
 * in one process, as the packets the controller was given. */
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "controller.h"
#include "supervisor.hpp"
#include "world.hpp"

using namespace grrl_sim;

namespace
{

constexpr int most_pushes = 100;
constexpr int rest_frames = 10;

struct Run {
    std::FILE *file = nullptr;
    std::unique_ptr<onboard_controller> controller = std::make_unique<onboard_controller>();
    onboard_packet packet{};
    Frame frame;
    onboard_points points{};
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

/* Whether the learner could do it. */
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

/* For whoever replays it: what it should have come to by now. */
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
    uint32_t n = 0;
    for (const TrackedFeature &feature : run.frame.features) {
        if (n == GRRL_MAX_FEATURES)
            break;
        run.points.id[n] = static_cast<int32_t>(feature.id);
        run.points.x_m[n] = static_cast<float>(feature.x_m);
        run.points.y_m[n] = static_cast<float>(feature.y_m);
        n++;
    }
    grrl_frame frame = {n, run.points.id, run.points.x_m, run.points.y_m};
    onboard_put_frame(&run.packet, &frame, pushing);
    send(run);
}

void settle(Run &run, World &world)
{
    for (int i = 0; i < rest_frames; i++)
        see(run, world, false);
    send(run, ONBOARD_PERCEIVE);
}

/* What the learner just decided, as the robot takes it. A refused push moves nothing. */
void push(Run &run, World &world)
{
    onboard_packet &answer = run.controller->answer;
    answer.at = 1; /* after the status */
    grrl_decision decision;
    if (!onboard_get_decision(&answer, &decision))
        run.failed = true;
    const grrl_push &chosen = decision.push;
    PushCommand command;
    command.start_m = {static_cast<double>(chosen.start_m.x),
                       static_cast<double>(chosen.start_m.y)};
    command.end_m = {static_cast<double>(chosen.end_m.x), static_cast<double>(chosen.end_m.y)};
    command.travel_m = static_cast<double>(chosen.travel_m);
    command.speed_m_s = static_cast<double>(chosen.speed_m_s);
    command.force_limit_n = static_cast<double>(chosen.force_n);
    command.timeout_s = static_cast<double>(chosen.timeout_s);
    if (!world.begin_push(command).empty())
        return;
    bool moving = true;
    while (moving) {
        moving = world.step_frame();
        see(run, world, true);
    }
}

/* The n-th trial of a seed has its own pose, noise and friction, as in grrl-sim. */
uint64_t trial_seed(uint64_t seed, uint32_t trial)
{
    grrl_random random;
    grrl_random_init(&random, seed, trial);
    uint64_t high = grrl_random_next(&random);
    return high << 32 | grrl_random_next(&random);
}

int trial(Run &run, const ObjectSpec &object, uint64_t seed, uint32_t number)
{
    World world(object, WorldParams{}, trial_seed(seed, number));
    Supervisor supervisor(object.truth);
    send(run, ONBOARD_TRIAL, number, 4);
    settle(run, world);
    int pushes = 0;
    bool found = false;
    while (!run.failed && !found && pushes < most_pushes) {
        if (!send(run, ONBOARD_CHOOSE))
            break; /* no link is seen that could be pushed */
        push(run, world);
        pushes++;
        settle(run, world);
        grrl_graph believed;
        const grrl_learner &learner = run.controller->learner;
        grrl_relational_state_of(grrl_perception_model(&learner.perception), learner.config.large_m,
                                 &believed, nullptr, nullptr);
        found = supervisor.judge(believed).correct;
        send(run, ONBOARD_LEARN, found ? 1 : 0, 1);
        expect(run);
    }
    return pushes;
}

const char help[] =
    "Usage: grrl-record OBJECT TRIALS SEED learn|paper RECORDING\n"
    "Runs the simulated world and the controller in one process, and writes the packets that the\n"
    "controller was given; grrl-replay and the images in onboard/ read them.\n\n"
    "  --help     print this text\n"
    "  --version  print the version\n\n"
    "Exit status: 0 fine; 1 trouble; 2 wrong command line.\n";

/* Whole numbers, nothing behind them. */
bool take_number(const char *text, uint64_t low, uint64_t high, uint64_t &value)
{
    char *end = nullptr;
    errno = 0;
    value = std::strtoull(text, &end, 10);
    return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0 && value >= low &&
           value <= high;
}

int wrong_usage(const char *what)
{
    (void)std::fprintf(stderr, "grrl-record: %s\nTry grrl-record --help\n", what);
    return 2;
}

} // namespace

int main(int argc, char **argv)
{
    const std::string first = argc == 2 ? argv[1] : "";
    if (first == "--help")
        return std::fputs(help, stdout) < 0;
    if (first == "--version")
        return std::puts("grrl-record " GRRL_VERSION) < 0;
    if (argc != 6)
        return wrong_usage("expected OBJECT TRIALS SEED POLICY RECORDING");
    uint64_t trials = 0;
    uint64_t seed = 0;
    const std::string policy = argv[4];
    if (!take_number(argv[2], 1, 1000000, trials))
        return wrong_usage("TRIALS must be a number from 1 to 1000000");
    if (!take_number(argv[3], 0, UINT64_MAX, seed))
        return wrong_usage("SEED must be a number from 0");
    if (policy != "learn" && policy != "paper")
        return wrong_usage("POLICY must be learn or paper");
    Result<ObjectSpec> object = object_from_text(argv[1]);
    Run run;
    if (object)
        run.file = std::fopen(argv[5], "wb");
    if (run.file == nullptr) {
        std::string why = object ? std::string(argv[5]) + ": cannot be written" : object.error;
        (void)std::fprintf(stderr, "grrl-record: %s\n", why.c_str());
        return 1;
    }
    open(run, seed, policy.c_str());
    (void)std::printf("pushes");
    for (uint32_t i = 1; i <= trials && !run.failed; i++)
        (void)std::printf(" %d", trial(run, *object.value, seed, i));
    (void)std::printf("\n");
    if (!send(run, ONBOARD_CLOSE) || std::fclose(run.file) != 0 || run.failed) {
        (void)std::fprintf(stderr, "grrl-record: %s is not complete\n", argv[5]);
        return 1;
    }
    return 0;
}
