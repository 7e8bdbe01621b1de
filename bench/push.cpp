/*
 * push.cpp: grrl-bench-push, which grrl-bench push runs: what a push costs, and which part it is.
 *
 * A run of grrl-experiment, agent and simulator in one process over memq. The linker puts the
 * functions below in front of those that they are named after (--wrap); each tells the meter which
 * part begins. With valgrind the run is repeated under callgrind, which counts instructions and
 * needs no meter; without it the meter reads the processor's counter, or failing that the time.
 */
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>

#include <linux/perf_event.h>
#include <sys/syscall.h>
#include <unistd.h>

#include "object.hpp"
#include "push_wrap.hpp"
#include "transport.hpp"

using namespace grrl_bench_push;

namespace
{

constexpr int trials = 10;

const char *const names[PARTS] = {"perception", "Box2D", "tracker", "wire", "choosing and learning",
                                  "other"};

/* What callgrind calls the functions of a part, without what is called from a handler. */
struct Named {
    Part part;
    const char *name;
};
const Named functions[] = {
    {PERCEPTION, "grrl_perception_observe"},
    {PERCEPTION, "grrl_perception_update"},
    {BOX2D, "__wrap__ZN7b2World4StepEfii"},
    {TRACKER, "grrl_sim::Tracker::observe("},
    {WIRE, "__wrap_lcm_handle_timeout"},
    {WIRE, "__wrap_lcm_publish"},
    {WIRE, "__wrap_grrl_wire_"},
    {LEARNER, "grrl_learner_choose"},
    {LEARNER, "grrl_learner_learn"},
};

struct Cost {
    const char *unit; /* of a million */
    double part[PARTS] = {};
    int pushes = 0;
};

int perf_counter()
{
    perf_event_attr attr{};
    attr.type = PERF_TYPE_HARDWARE;
    attr.size = sizeof attr;
    attr.config = PERF_COUNT_HW_INSTRUCTIONS;
    attr.exclude_kernel = 1;
    attr.exclude_hv = 1;
    return static_cast<int>(syscall(SYS_perf_event_open, &attr, 0, -1, -1, 0));
}

int run()
{
    grrl_experiment::Phase phase;
    const grrl_sim::ObjectSpec object = *grrl_sim::object_from_text("RPRPRPR").value;
    phase.objects = [&object](uint64_t, int32_t) { return object; };
    phase.policy = grrl_experiment::find_policy("learn");
    phase.trials = trials;
    int pushes = 0;
    grrl_experiment::run_over_memq(
        phase, {}, [&pushes](const grrl_experiment::TrialRow &row) { pushes += row.pushes; });
    return pushes;
}

Cost measure_here()
{
    Cost cost;
    int counter = perf_counter();
    cost.unit = counter >= 0 ? "M instructions (counted by the processor)" : "ms of processor time";
    meter_start(counter);
    cost.pushes = run();
    meter_stop(cost.part);
    return cost;
}

/* "1,234 (5.6%) file:function [object]" */
bool read_line(const char *line, double &value, std::string &function)
{
    const char *percent = std::strstr(line, "%) ");
    const char *colon = percent == nullptr ? nullptr : std::strchr(percent, ':');
    if (colon == nullptr)
        return false;
    std::string digits;
    for (const char *c = line; *c != '(' && *c != '\0'; c++)
        if (*c >= '0' && *c <= '9')
            digits += *c;
    value = std::atof(digits.c_str());
    function = colon + 1;
    return true;
}

/* Inclusive costs of functions: what a handler costs is taken from the wire that called it, and
 * what no part claims is the rest. */
void add_function(const std::string &function, double value, Cost &cost)
{
    if (function.rfind("(anonymous namespace)::run()", 0) == 0)
        cost.part[OTHER] += value;
    if (function.rfind("grrl_bench_push::handle(", 0) == 0) {
        cost.part[WIRE] -= value;
        cost.part[OTHER] += value;
    }
    for (const Named &named : functions) {
        if (function.rfind(named.name, 0) != 0)
            continue;
        cost.part[named.part] += value;
        cost.part[OTHER] -= value;
        return;
    }
}

bool measure_by_callgrind(const char *self, Cost &cost)
{
    if (std::system("command -v valgrind >/dev/null 2>&1") != 0)
        return false;
    char file[] = "/tmp/grrl-bench-XXXXXX";
    int fd = mkstemp(file);
    if (fd < 0)
        return false;
    (void)close(fd);
    std::string command = std::string("valgrind -q --tool=callgrind --callgrind-out-file=") + file +
                          " '" + self + "' counted && callgrind_annotate --inclusive=yes " +
                          "--threshold=100 " + file;
    std::FILE *lines = popen(command.c_str(), "r");
    char line[4096];
    while (lines != nullptr && std::fgets(line, sizeof line, lines) != nullptr) {
        double value;
        std::string function;
        if (std::sscanf(line, "pushes %d", &cost.pushes) != 1 && read_line(line, value, function))
            add_function(function, value / 1e6, cost);
    }
    bool good = lines != nullptr && pclose(lines) == 0 && cost.pushes > 0;
    (void)unlink(file);
    cost.unit = "M instructions (callgrind)";
    return good;
}

void print(const Cost &cost, bool json)
{
    double all = 0.0;
    for (double part : cost.part)
        all += part;
    (void)std::printf(json ? "{\"pushes\": %d, \"unit\": \"%s\"" : "%d pushes; %s a push:\n\n",
                      cost.pushes, cost.unit);
    if (!json)
        (void)std::printf("| part | a push | share | raw Box2D = 1 |\n|---|---|---|---|\n");
    for (int i = 0; i <= PARTS; i++) {
        double part = i < PARTS ? cost.part[i] : all;
        const char *name = i < PARTS ? names[i] : "all";
        if (json)
            (void)std::printf(", \"%s\": %.4f", name, part / cost.pushes);
        else
            (void)std::printf("| %s | %.2f | %.1f%% | %.2f |\n", name, part / cost.pushes,
                              100.0 * part / all, part / cost.part[BOX2D]);
    }
    if (json)
        (void)std::puts("}");
}

} // namespace

int main(int argc, char **argv)
{
    try {
        if (argc > 1 && std::strcmp(argv[1], "counted") == 0)
            return std::printf("pushes %d\n", run()) < 0;
        Cost cost{};
        if (!measure_by_callgrind(argv[0], cost))
            cost = measure_here();
        print(cost, argc > 1);
    } catch (const std::exception &error) {
        (void)std::fprintf(stderr, "grrl-bench: %s\n", error.what());
        return 1;
    }
    return 0;
}
