#include "motion.hpp"

#include <algorithm>
#include <cmath>

namespace grrl_experiment
{

namespace
{

struct Line {
    double x;
    double y;
};

Line unit(double x, double y)
{
    double length = std::hypot(x, y);
    return length > 0.0 ? Line{x / length, y / length} : Line{0.0, 0.0};
}

Line between(grrl_vec2 from, grrl_vec2 to)
{
    return unit(static_cast<double>(to.x) - static_cast<double>(from.x),
                static_cast<double>(to.y) - static_cast<double>(from.y));
}

double sine(Line a, Line b)
{
    return std::abs(a.x * b.y - a.y * b.x);
}

double cosine(Line a, Line b)
{
    return std::abs(a.x * b.x + a.y * b.y);
}

double of_known_joints(const grrl_model &model, int body, Line push)
{
    double sum = 0.0;
    for (int i = 0; i < model.n_joints; i++) {
        const grrl_joint &joint = model.joint[i];
        if (joint.a != body && joint.b != body)
            continue;
        Line arm = between(joint.point_m, model.body[body].centroid_m);
        if (joint.type == GRRL_REVOLUTE)
            sum += static_cast<double>(joint.p_revolute) * sine(arm, push);
        else
            sum +=
                static_cast<double>(joint.p_prismatic) *
                cosine(unit(static_cast<double>(joint.axis.x), static_cast<double>(joint.axis.y)),
                       push);
    }
    return sum;
}

double of_unknown_joints(const grrl_model &model, int body, Line push)
{
    float shortest = model.body[body].length_m;
    for (int i = 0; i < model.n_bodies; i++)
        shortest = std::min(shortest, model.body[i].length_m);
    double hidden =
        shortest > 0.0f ? static_cast<double>(model.body[body].length_m / shortest) : 1.0;
    Line axis = unit(static_cast<double>(model.body[body].axis.x),
                     static_cast<double>(model.body[body].axis.y));
    return hidden * 0.5 * (sine(axis, push) + cosine(axis, push));
}

class Motion : public Chooser
{
public:
    void begin_trial() override { tried_.clear(); }
    Action choose(const grrl_model &model) override;

private:
    Tried tried_;
};

Action Motion::choose(const grrl_model &model)
{
    tried_.look(model);
    Action best{model.body[0].number, 0};
    double most = -1.0;
    for (int body = 0; body < model.n_bodies; body++) {
        for (uint8_t direction = 0; direction < GRRL_DIRECTIONS; direction++) {
            Action action{model.body[body].number, direction};
            double motion = tried_.has(action) ? -1.0 : expected_motion(model, body, direction);
            if (motion > most) {
                most = motion;
                best = action;
            }
        }
    }
    tried_.add(best);
    return best;
}

} // namespace

double expected_motion(const grrl_model &model, int body, uint8_t direction)
{
    grrl_grounding_config config;
    grrl_grounding_config_default(&config);
    grrl_push push;
    if (grrl_grounding_push(&model, &config, static_cast<uint8_t>(body), direction, &push) !=
        GRRL_OK)
        return 0.0;
    Line along = between(push.start_m, push.end_m);
    return of_known_joints(model, body, along) + of_unknown_joints(model, body, along);
}

std::unique_ptr<Chooser> make_motion()
{
    return std::make_unique<Motion>();
}

} // namespace grrl_experiment
