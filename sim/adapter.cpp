/* adapter.cpp: converts pushes (double) and points (float). */
#include "adapter.hpp"

#include <algorithm>

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
    const int n = std::min(capacity, static_cast<int>(frame.features.size()));
    const TrackedFeature *feature = frame.features.data();
    for (int i = 0; i < n; i++) {
        id[i] = static_cast<int32_t>(feature[i].id);
        x_m[i] = static_cast<float>(feature[i].x_m);
        y_m[i] = static_cast<float>(feature[i].y_m);
    }
    return n;
}

grrl_frame FrameArrays::frame_of(const Frame &frame)
{
    int n = copy_points(frame, GRRL_MAX_FEATURES, id_, x_m_, y_m_);
    return {static_cast<uint32_t>(n), id_, x_m_, y_m_};
}

} // namespace grrl_sim
