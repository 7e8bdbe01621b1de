/* Draws joint values and a place until no links overlap. */
#include "placement.hpp"

#include "kinematics.hpp"

namespace grrl_sim
{

namespace
{

constexpr int attempts = 200;
constexpr int attempts_before_bending = 40;
constexpr int places_tried = 30;
constexpr double link_clearance_m = 0.002;
constexpr double object_clearance_m = 0.03;
constexpr double table_margin_m = 0.02;

struct Box {
    Vec2 low{1e9, 1e9};
    Vec2 high{-1e9, -1e9};

    void include(const Rectangle &shape)
    {
        for (int corner = 0; corner < 4; corner++) {
            double x = (corner & 1) != 0 ? shape.half_length : -shape.half_length;
            double y = (corner & 2) != 0 ? shape.half_width : -shape.half_width;
            Vec2 point = transform(shape.pose, {x, y});
            low = {std::min(low.x, point.x), std::min(low.y, point.y)};
            high = {std::max(high.x, point.x), std::max(high.y, point.y)};
        }
    }
};

class Placement
{
public:
    Placement(const ObjectSpec &object, Vec2 table_m, Random &random)
        : object_(object),
          forest_(spanning_forest(object)), room_{table_m.x / 2.0 - table_margin_m,
                                                  table_m.y / 2.0 - table_margin_m},
          random_(random)
    {
    }

    std::vector<Pose> run()
    {
        std::vector<Pose> fallback(object_.links.size());
        for (int attempt = 0; attempt < attempts; attempt++) {
            std::vector<double> values = draw_values(attempt);
            if (!close_loops(object_, forest_, values) || !within_limits(values))
                continue;
            poses_ = link_poses(object_, forest_, values);
            bool fits = place_components();
            fallback = poses_;
            if (fits && !links_overlap(object_, poses_, link_clearance_m))
                break;
        }
        return fallback;
    }

private:
    /* The last attempt uses the middle of all ranges, which is known to close. */
    std::vector<double> draw_values(int attempt)
    {
        double bend =
            std::max(0, attempt - attempts_before_bending) / static_cast<double>(attempts);
        std::vector<double> values;
        for (const JointSpec &joint : object_.joints) {
            double low = joint.initial_lower + bend * (joint.lower - joint.initial_lower);
            double high = joint.initial_upper + bend * (joint.upper - joint.initial_upper);
            double middle = (joint.initial_lower + joint.initial_upper) / 2.0;
            values.push_back(attempt + 1 < attempts ? random_.uniform(low, high) : middle);
        }
        return values;
    }

    bool within_limits(const std::vector<double> &values) const
    {
        for (size_t j = 0; j < values.size(); j++)
            if (values[j] < object_.joints[j].lower || values[j] > object_.joints[j].upper)
                return false;
        return true;
    }

    bool place_components()
    {
        bool all_fit = true;
        for (int c = 0; c < static_cast<int>(forest_.roots.size()); c++) {
            bool fits = false;
            for (int i = 0; i < places_tried && !fits; i++)
                fits = place_at_random(c);
            if (!fits)
                place_beside(c);
            all_fit = all_fit && fits;
        }
        return all_fit;
    }

    Box box_of(int component, bool all_up_to) const
    {
        Box box;
        for (size_t i = 0; i < poses_.size(); i++) {
            int c = forest_.component[i];
            if (c == component || (all_up_to && c < component))
                box.include(link_rectangle(object_.links[i], poses_[i]));
        }
        return box;
    }

    void move(int component, const Pose &by)
    {
        for (size_t i = 0; i < poses_.size(); i++)
            if (forest_.component[i] == component)
                poses_[i] = compose(by, poses_[i]);
    }

    bool place_at_random(int component)
    {
        move(component, {{0.0, 0.0}, random_.uniform(-pi, pi)});
        Box box = box_of(component, false);
        Vec2 slack{room_.x - (box.high.x - box.low.x) / 2.0,
                   room_.y - (box.high.y - box.low.y) / 2.0};
        if (slack.x < 0.0 || slack.y < 0.0)
            return false;
        Vec2 centre = 0.5 * (box.low + box.high);
        double x = random_.uniform(-slack.x, slack.x);
        Vec2 target{x, random_.uniform(-slack.y, slack.y)};
        move(component, {target - centre, 0.0});
        return clear_of_others(component);
    }

    bool clear_of_others(int component) const
    {
        for (size_t i = 0; i < poses_.size(); i++) {
            for (size_t k = 0; k < poses_.size(); k++) {
                if (forest_.component[i] != component || forest_.component[k] >= component)
                    continue;
                if (overlap(link_rectangle(object_.links[i], poses_[i]),
                            link_rectangle(object_.links[k], poses_[k]), object_clearance_m))
                    return false;
            }
        }
        return true;
    }

    /* Centred if it is alone, else to the right of the others, even over the edge. */
    void place_beside(int component)
    {
        Box box = box_of(component, false);
        Vec2 target;
        if (component > 0)
            target.x = box_of(component - 1, true).high.x + object_clearance_m +
                       (box.high.x - box.low.x) / 2.0;
        move(component, {target - 0.5 * (box.low + box.high), 0.0});
    }

    const ObjectSpec &object_;
    Forest forest_;
    Vec2 room_;
    Random &random_;
    std::vector<Pose> poses_;
};

} // namespace

std::vector<Pose> random_poses(const ObjectSpec &object, Vec2 table_m, Random &random)
{
    return Placement(object, table_m, random).run();
}

} // namespace grrl_sim
