/* Checks a push, and classifies how it ended. */
#include "push.hpp"

#include <sstream>

namespace grrl_sim
{

namespace
{

constexpr double beside_table_m = 0.5;
constexpr double shortest_line_m = 0.001;

std::string check_point(const char *name, Vec2 point, Vec2 table_m)
{
    double x = table_m.x / 2.0 + beside_table_m;
    double y = table_m.y / 2.0 + beside_table_m;
    if (std::abs(point.x) <= x && std::abs(point.y) <= y) /* false for NaN */
        return {};
    std::ostringstream message;
    message << name << " (" << point.x << ", " << point.y
            << ") m is off the table; it must be finite, x within +-" << x << " and y within +-"
            << y << " m";
    return message.str();
}

std::string check_amount(const char *name, double value, double most, const char *unit)
{
    if (value > 0.0 && value <= most)
        return {};
    std::ostringstream message;
    message << name << " " << value << " " << unit << " must be above 0 and at most " << most;
    return message.str();
}

} // namespace

const char *push_reason_text(PushReason reason)
{
    switch (reason) {
    case PushReason::REACHED:
        return "reached";
    case PushReason::MISSED:
        return "missed";
    case PushReason::BLOCKED:
        return "blocked";
    case PushReason::TIMEOUT:
        return "timeout";
    }
    return "unknown";
}

std::string check_push(const PushCommand &command, Vec2 table_m)
{
    std::string problem = check_point("start", command.start_m, table_m);
    if (problem.empty())
        problem = check_point("end", command.end_m, table_m);
    if (problem.empty() && length(command.end_m - command.start_m) < shortest_line_m)
        problem = "start and end are the same point; they must be at least 0.001 m apart";
    if (problem.empty())
        problem = check_amount("speed", command.speed_m_s, 0.5, "m/s");
    if (problem.empty())
        problem = check_amount("force limit", command.force_limit_n, 10.0, "N");
    if (problem.empty())
        problem = check_amount("travel", command.travel_m, 0.5, "m");
    if (problem.empty())
        problem = check_amount("timeout", command.timeout_s, 10.0, "s");
    return problem;
}

} // namespace grrl_sim
