/* adapter.hpp: converts the simulator's frames for the library, and the library's pushes for the
 * simulator. */
#ifndef GRRL_SIM_ADAPTER_HPP
#define GRRL_SIM_ADAPTER_HPP

#include "grrl/learner/grounding.h"
#include "grrl/perception/perception.h"
#include "push.hpp"
#include "tracker.hpp"

namespace grrl_sim
{

/* The learner's push as a robot command. */
PushCommand command_of(const grrl_push &push);

/* Copies the points of a frame, at most `capacity`. Returns how many. */
int copy_points(const Frame &frame, int capacity, int32_t *id, float *x_m, float *y_m);

/* The arrays that a library frame points to. */
class FrameArrays
{
public:
    /* Valid until the next call. */
    grrl_frame frame_of(const Frame &frame);

private:
    int32_t id_[GRRL_MAX_FEATURES];
    float x_m_[GRRL_MAX_FEATURES];
    float y_m_[GRRL_MAX_FEATURES];
};

} // namespace grrl_sim

#endif
