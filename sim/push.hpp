/*
 * push.hpp: a push command and its result, in metres, newtons and seconds on the table plane. It
 * contains no link names.
 */
#ifndef GRRL_SIM_PUSH_HPP
#define GRRL_SIM_PUSH_HPP

#include <string>

#include "geometry.hpp"

namespace grrl_sim
{

/* The finger comes down at start, moves straight to end, and stops `travel` after first contact. */
struct PushCommand {
    Vec2 start_m;                /* on the table or at most 0.5 m beside it, as is end */
    Vec2 end_m;                  /* at least 1 mm from start */
    double speed_m_s = 0.08;     /* above 0, at most 0.5 */
    double force_limit_n = 10.0; /* above 0, at most 10 */
    double travel_m = 0.03;      /* after the first contact, above 0, at most 0.5 */
    double timeout_s = 2.5;      /* above 0, at most 10 */
};

enum class PushReason {
    REACHED, /* made contact and continued for its travel, or to the end of the line */
    MISSED,  /* reached the end of the line without contact */
    BLOCKED, /* no progress for 0.3 s at the force limit, or no free place to come down */
    TIMEOUT
};

struct PushResult {
    PushReason reason = PushReason::MISSED;
    bool touched = false;
    double duration_s = 0.0;
    double travelled_m = 0.0; /* after the first contact */
    Vec2 from_m;              /* where the finger came down */
    Vec2 to_m;                /* where it was lifted */
};

const char *push_reason_text(PushReason reason);

/* Empty if the command can be executed, else what is wrong and what would be right. */
std::string check_push(const PushCommand &command, Vec2 table_m);

} // namespace grrl_sim

#endif
