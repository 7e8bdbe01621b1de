/* own_plant URL SECONDS [MISTAKE]: a tracker and a robot without supervisor around the simulated
 * world, 100 frames a second, with a mistake: see the table. Ends with 0 after so many seconds. */
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "own_plant.hpp"

namespace
{

struct Mistake {
    const char *name;
    PlantMistakes does;
    int period_ms;
    double stop_s; /* when the red button is pressed; 0: never */
};

const Mistake mistakes[] = {
    {"none", {}, 10, 0.0},
    {"no_status", {true, false, 0, 0, GRRL_POINTS_T_UNKNOWN, 1.0, false, false}, 10, 0.0},
    {"trial", {false, false, 0, 1, GRRL_POINTS_T_UNKNOWN, 1.0, false, false}, 10, 0.0},
    {"rest", {false, false, 0, 0, GRRL_POINTS_T_REST, 1.0, false, false}, 10, 0.0},
    {"millimetres", {false, false, 0, 0, GRRL_POINTS_T_UNKNOWN, 1000.0, false, false}, 10, 0.0},
    {"ids", {false, false, 0, 0, GRRL_POINTS_T_UNKNOWN, 1.0, true, false}, 10, 0.0},
    {"slow", {}, 125, 0.0},
    {"stop", {}, 10, 1.0},
};

double now_s()
{
    using namespace std::chrono;
    return duration<double>(steady_clock::now().time_since_epoch()).count();
}

/* Handles messages until the next frame is due. */
bool wait_until(lcm_t *lcm, double due_s)
{
    for (double left = due_s - now_s(); left > 0.0; left = due_s - now_s())
        if (lcm_handle_timeout(lcm, 1 + static_cast<int>(left * 1000.0)) < 0)
            return false;
    return true;
}

int run(lcm_t *lcm, double seconds, const Mistake &mistake)
{
    OwnPlant plant(lcm, "RR", 5, mistake.does);
    const double start_s = now_s();
    double due_s = start_s;
    bool stopped = false;
    while (now_s() - start_s < seconds) {
        plant.frame(static_cast<int64_t>(now_s() * 1e6));
        if (!stopped && mistake.stop_s > 0.0 && now_s() - start_s >= mistake.stop_s) {
            plant.stop(GRRL_STOP_T_COLLISION);
            stopped = true;
        }
        due_s += mistake.period_ms * 1e-3;
        if (!wait_until(lcm, due_s))
            return 1;
    }
    (void)std::printf("%d pushes, %d commands\n", plant.pushes(), plant.commands());
    return 0;
}

} // namespace

int main(int argc, char **argv)
{
    if (argc < 3 || argc > 4)
        return 2;
    lcm_t *lcm = lcm_create(argv[1]);
    if (lcm == nullptr)
        return 1;
    int status = 2;
    for (const Mistake &mistake : mistakes)
        if (std::strcmp(mistake.name, argc == 4 ? argv[3] : "none") == 0)
            status = run(lcm, std::atof(argv[2]), mistake);
    lcm_destroy(lcm);
    return status;
}
