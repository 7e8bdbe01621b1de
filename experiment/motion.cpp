/* motion.cpp: chooses the push that should move the joints whose type is uncertain. */
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

/* The part of its travel that a push transmits to a body, and its direction. */
struct Thrust {
    Line along;
    double share;
};

Line axis_of(const grrl_body &body)
{
    return unit(static_cast<double>(body.axis.x), static_cast<double>(body.axis.y));
}

Thrust thrust_of(const grrl_body &body, Line push)
{
    Line axis = axis_of(body);
    bool from_behind = cosine(axis, push) > 0.9;
    return from_behind ? Thrust{axis, cosine(axis, push)}
                       : Thrust{{-axis.y, axis.x}, sine(axis, push)};
}

double of_known_joints(const grrl_model &model, int body, Line along)
{
    double sum = 0.0;
    for (int i = 0; i < model.n_joints; i++) {
        const grrl_joint &joint = model.joint[i];
        if (joint.a != body && joint.b != body)
            continue;
        Line arm = between(joint.point_m, model.body[body].centroid_m);
        Line axis = unit(static_cast<double>(joint.axis.x), static_cast<double>(joint.axis.y));
        double moves = joint.type == GRRL_REVOLUTE ? sine(arm, along) : cosine(axis, along);
        sum += (1.0 - static_cast<double>(joint.probability)) * moves;
    }
    return sum;
}

double of_unknown_joints(const grrl_model &model, int body)
{
    float shortest = model.body[body].length_m;
    for (int i = 0; i < model.n_bodies; i++)
        shortest = std::min(shortest, model.body[i].length_m);
    return shortest > 0.0f ? 0.5 * static_cast<double>(model.body[body].length_m / shortest) : 0.5;
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
    tried_.update(model);
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
    Thrust thrust = thrust_of(model.body[body], between(push.start_m, push.end_m));
    return thrust.share *
           (of_known_joints(model, body, thrust.along) + of_unknown_joints(model, body));
}

std::unique_ptr<Chooser> make_motion()
{
    return std::make_unique<Motion>();
}

} // namespace grrl_experiment
