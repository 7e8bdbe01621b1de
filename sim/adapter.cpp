/* adapter.cpp: converts pushes (double) and points (float). */
#include "adapter.hpp"

namespace grrl_sim
{

PushCommand command_of(const grrl_push &push)
{
    PushCommand command;
    command.start_m = {static_cast<double>(push.start_m.x), static_cast<double>(push.start_m.y)};
    command.end_m = {static_cast<double>(push.end_m.x), static_cast<double>(push.end_m.y)};
    command.travel_m = static_cast<double>(push.travel_m);
    command.speed_m_s = static_cast<double>(push.speed_m_s);
    command.force_limit_n = static_cast<double>(push.force_n);
    command.timeout_s = static_cast<double>(push.timeout_s);
    return command;
}

int copy_points(const Frame &frame, int capacity, int32_t *id, float *x_m, float *y_m)
{
    int n = 0;
    for (const TrackedFeature &feature : frame.features) {
        if (n == capacity)
            break;
        id[n] = static_cast<int32_t>(feature.id);
        x_m[n] = static_cast<float>(feature.x_m);
        y_m[n] = static_cast<float>(feature.y_m);
        n++;
    }
    return n;
}

grrl_frame FrameArrays::frame_of(const Frame &frame)
{
    int n = copy_points(frame, GRRL_MAX_FEATURES, id_, x_m_, y_m_);
    return {static_cast<uint32_t>(n), id_, x_m_, y_m_};
}

} // namespace grrl_sim
