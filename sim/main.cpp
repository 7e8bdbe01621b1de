/* grrl-sim: options, files, signals and terminal output around the node. */
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <random>

#include <lcm/eventlog.h>

#include "node.hpp"
#include "options.hpp"

using namespace grrl_sim;

namespace
{

constexpr int poll_ms = 5;
constexpr int64_t hint_period_us = 5000000;

volatile std::sig_atomic_t stop = 0;

/* The time of day at the start plus the time since. Setting the clock meanwhile must not change
 * what is due. */
int64_t now_us()
{
    using namespace std::chrono;
    static const auto offset =
        system_clock::now().time_since_epoch() - steady_clock::now().time_since_epoch();
    return duration_cast<microseconds>(steady_clock::now().time_since_epoch() + offset).count();
}

int64_t random_session()
{
    std::random_device device;
    uint64_t bits = static_cast<uint64_t>(device()) << 32 | device();
    bits ^= static_cast<uint64_t>(now_us());
    int64_t session = static_cast<int64_t>(bits & INT64_MAX);
    return session != 0 ? session : 1;
}

const char *outcome_text(int8_t outcome)
{
    switch (outcome) {
    case GRRL_TRIAL_T_DISCOVERED:
        return "discovered";
    case GRRL_TRIAL_T_CAPPED:
        return "capped";
    default:
        return "aborted";
    }
}

/* Writes every message of the node to an LCM log. */
class Log
{
public:
    explicit Log(const std::string &path) : log_(lcm_eventlog_create(path.c_str(), "w")) {}
    ~Log()
    {
        if (log_ != nullptr)
            lcm_eventlog_destroy(log_);
    }
    Log(const Log &) = delete;
    Log &operator=(const Log &) = delete;

    bool open() const { return log_ != nullptr; }

    void write(const char *channel, const void *data, uint32_t size)
    {
        /* The interface lacks const; the data is not changed. */
        lcm_eventlog_event_t event{};
        event.timestamp = now_us();
        event.channellen = static_cast<int32_t>(std::strlen(channel));
        event.datalen = static_cast<int32_t>(size);
        event.channel = const_cast<char *>(channel);
        event.data = const_cast<void *>(data);
        failed_ = failed_ || lcm_eventlog_write_event(log_, &event) != 0;
    }

    bool failed() const { return failed_; }

private:
    lcm_eventlog_t *log_;
    bool failed_ = false;
};

class Results
{
public:
    explicit Results(const Options &options) : quiet_(options.quiet)
    {
        if (options.results.empty())
            return;
        file_ = std::fopen(options.results.c_str(), "w");
        if (file_ == nullptr || std::fputs("trial,pushes,outcome\n", file_) < 0)
            failed_ = true;
    }
    ~Results()
    {
        if (file_ != nullptr)
            (void)std::fclose(file_);
    }
    Results(const Results &) = delete;
    Results &operator=(const Results &) = delete;

    void add(const TrialResult &result)
    {
        const char *outcome = outcome_text(result.outcome);
        if (result.outcome != GRRL_TRIAL_T_ABORTED) {
            trials_++;
            pushes_ += result.pushes;
        }
        double mean = trials_ > 0 ? static_cast<double>(pushes_) / trials_ : 0.0;
        if (!quiet_)
            (void)std::printf("trial %d: %d pushes, %s, mean %.2f\n", result.trial_id,
                              result.pushes, outcome, mean);
        (void)std::fflush(stdout);
        if (file_ == nullptr)
            return;
        bool good = std::fprintf(file_, "%d,%d,%s\n", result.trial_id, result.pushes, outcome) > 0;
        failed_ = std::fflush(file_) != 0 || !good || failed_;
    }

    bool failed() const { return failed_; }

private:
    std::FILE *file_ = nullptr;
    bool quiet_;
    bool failed_ = false;
    int trials_ = 0;
    int64_t pushes_ = 0;
};

lcm_t *open_lcm(const std::string &url)
{
    lcm_t *lcm = lcm_create(url.empty() ? nullptr : url.c_str());
    if (lcm != nullptr && lcm_get_fileno(lcm) >= 0)
        return lcm;
    (void)std::fprintf(stderr, "grrl-sim: cannot start LCM. If this machine has no network:\n"
                               "  ip link set lo up; ip route add 224.0.0.0/4 dev lo\n"
                               "or choose another provider with --lcm-url.\n");
    if (lcm != nullptr)
        lcm_destroy(lcm);
    return nullptr;
}

/* False once the wait for an agent is over. */
bool wait_for_agent(const Node &node, const Options &options, int64_t &hint_us)
{
    int64_t silent = node.agent_silent_us();
    if (options.agent_timeout_s > 0.0 &&
        static_cast<double>(silent) >= options.agent_timeout_s * 1e6) {
        (void)std::fprintf(stderr, "grrl-sim: heard no agent for %g s, giving up\n",
                           options.agent_timeout_s);
        return false;
    }
    if (silent < hint_period_us)
        hint_us = 0;
    if (silent - hint_us >= hint_period_us) {
        hint_us = silent;
        if (!options.quiet)
            (void)std::fprintf(stderr,
                               "grrl-sim: waiting for an agent on the same LCM provider: "
                               "start grrl-agent%s\n",
                               options.camera ? ", and grrl-track --lcm to track points for it"
                                              : "");
    }
    return true;
}

bool loop(Node &node, lcm_t *lcm, const Options &options, const Results &results, const Log *log)
{
    int64_t hint_us = 0;
    while (stop == 0 && !node.finished()) {
        if (lcm_handle_timeout(lcm, poll_ms) < 0 && stop == 0) {
            (void)std::fprintf(stderr, "grrl-sim: LCM failed to receive\n");
            return false;
        }
        node.tick();
        if (results.failed() || (log != nullptr && log->failed())) {
            (void)std::fprintf(stderr, "grrl-sim: cannot write the %s\n",
                               results.failed() ? options.results.c_str() : options.log.c_str());
            return false;
        }
        if (!wait_for_agent(node, options, hint_us))
            return false;
        if (node.agent_has_nothing_to_push()) {
            (void)std::fprintf(stderr, "grrl-sim: the agent finds nothing to push, giving up: too "
                                       "few points (--dropout) or too much noise (--noise)?\n");
            return false;
        }
    }
    return true;
}

/* The table is then the camera's field of view. */
bool add_camera(const Options &options, NodeConfig &config)
{
    config.camera = make_camera(options.look, PictureCoding::JPEG);
    config.world.table_m = camera_view_m(options.look);
    std::string problem = check_world(config.world);
    if (config.camera == nullptr)
        problem = "this build cannot render images because it was configured without OpenCV; run "
                  "tools/setup camera, then configure and build again";
    if (!problem.empty())
        (void)std::fprintf(stderr, "grrl-sim: --camera: %s\n", problem.c_str());
    return problem.empty();
}

int run(const Options &options, ObjectSpec object, lcm_t *lcm)
{
    Results results(options);
    std::unique_ptr<Log> log;
    if (!options.log.empty())
        log = std::make_unique<Log>(options.log);
    if (results.failed() || (log != nullptr && !log->open())) {
        (void)std::fprintf(stderr, "grrl-sim: cannot write %s\n",
                           results.failed() ? options.results.c_str() : options.log.c_str());
        return 1;
    }
    NodeConfig config;
    if (options.camera && !add_camera(options, config))
        return 1;
    config.object = std::move(object);
    config.world.tracker = options.tracker;
    config.seed = options.seed;
    config.trials = options.trials;
    config.cap = options.cap;
    config.real_time = options.real_time;
    config.session_id = random_session();
    config.now_us = now_us;
    config.on_trial = [&results](const TrialResult &result) { results.add(result); };
    if (!options.quiet)
        config.on_note = [](const std::string &text) {
            (void)std::fprintf(stderr, "grrl-sim: %s\n", text.c_str());
        };
    if (log != nullptr)
        config.on_message = [&log](const char *channel, const void *data, uint32_t size) {
            log->write(channel, data, size);
        };
    Node node(lcm, std::move(config));
    int64_t start_us = now_us();
    bool good = loop(node, lcm, options, results, log.get());
    if (!options.quiet)
        (void)std::printf("%lld frames in %.2f s\n", static_cast<long long>(node.frames()),
                          static_cast<double>(now_us() - start_us) * 1e-6);
    return good ? 0 : 1;
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    grrl_options_result parsed = parse_options(argc, argv, options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    Result<ObjectSpec> object = object_from_text(options.object);
    if (!object) {
        (void)std::fprintf(stderr, "grrl-sim: --object: %s\n", object.error.c_str());
        return 2;
    }
    (void)std::signal(
        SIGINT, [](int) { stop = 1; });
    (void)std::signal(SIGTERM, [](int) { stop = 1; });
    lcm_t *lcm = open_lcm(options.lcm_url);
    if (lcm == nullptr)
        return 1;
    int status = 1;
    try {
        status = run(options, std::move(*object.value), lcm);
    } catch (const std::exception &error) {
        (void)std::fprintf(stderr, "grrl-sim: %s\n", error.what());
    }
    lcm_destroy(lcm);
    return status;
}
