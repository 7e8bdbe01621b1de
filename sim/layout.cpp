/*
 * layout.cpp: assigns geometry to the links and joints of a bare structure.
 *
 * Every link has two slots at its ends; the others lie along its sides. A depth-first walk attaches
 * each link by its own -x end to the next slot of its parent, loops before branches. Chains are
 * therefore straight, branches stand out sideways, and a loop runs through the ends of its links. A
 * loop becomes a polygon: all its corners turn until it closes, and the resulting corner is the
 * joint's zero (for a prismatic corner it fixes the angle).
 */
#include <algorithm>

#include "kinematics.hpp"
#include "object.hpp"
#include "random.hpp"

namespace grrl_sim
{

namespace
{

constexpr double side_slot_spacing_m = 0.045;
constexpr int loop_attempts = 60;

struct Slot {
    Vec2 anchor_m;
    double outward_rad;
};

uint8_t vertex(int link)
{
    return static_cast<uint8_t>(link);
}

bool bit(uint32_t mask, int i)
{
    return (mask >> i & 1u) != 0;
}

int count_bits(uint32_t mask)
{
    int count = 0;
    for (; mask != 0; mask &= mask - 1)
        count++;
    return count;
}

/* Links reachable from a without the joint between a and b. */
uint32_t reached_around(const grrl_graph &graph, int a, int b)
{
    uint32_t reached = UINT32_C(1) << a;
    uint32_t before = 0;
    while (reached != before) {
        before = reached;
        for (int i = 0; i < graph.n; i++) {
            if (!bit(before, i))
                continue;
            uint32_t next = grrl_graph_neighbours(&graph, vertex(i));
            if (i == a)
                next &= ~(UINT32_C(1) << b);
            if (i == b)
                next &= ~(UINT32_C(1) << a);
            reached |= next;
        }
    }
    return reached;
}

bool in_loop(const grrl_graph &graph, int a, int b)
{
    return bit(reached_around(graph, a, b), b);
}

class Layout
{
public:
    explicit Layout(ObjectSpec &object)
        : object_(object), used_slots_(object.links.size(), 0), seen_(object.links.size(), false),
          entered_(object.links.size(), false)
    {
    }

    void run()
    {
        for (size_t i = 0; i < object_.links.size(); i++)
            make_room(static_cast<int>(i));
        for (int pass = 0; pass < 2; pass++) /* the background first, because it is a root */
            for (size_t i = 0; i < object_.links.size(); i++)
                if (!seen_[i] && object_.links[i].fixed == (pass == 0))
                    walk(static_cast<int>(i));
    }

private:
    uint32_t neighbours(int link) const
    {
        return grrl_graph_neighbours(&object_.truth, vertex(link));
    }

    int slots_per_side(int link) const { return (count_bits(neighbours(link)) - 1) / 2; }

    void make_room(int link)
    {
        LinkSpec &spec = object_.links[static_cast<size_t>(link)];
        double needed = side_slot_spacing_m * slots_per_side(link) / 2.0;
        spec.half_length_m = std::max(spec.half_length_m, needed);
    }

    Slot next_slot(int link)
    {
        const LinkSpec &spec = object_.links[static_cast<size_t>(link)];
        size_t l = static_cast<size_t>(link);
        int k = used_slots_[l]++;
        if (k < 2) {
            bool far_end = (k == 0) != entered_[l];
            double sign = far_end ? 1.0 : -1.0;
            return {{sign * spec.half_length_m, 0.0}, far_end ? 0.0 : pi};
        }
        int per_side = slots_per_side(link);
        double sign = k % 2 == 0 ? 1.0 : -1.0;
        double place = ((k - 2) / 2 + 0.5) / per_side;
        return {{(2.0 * place - 1.0) * spec.half_length_m, sign * spec.half_width_m},
                sign * pi / 2.0};
    }

    /* The next unplaced joint of a link, joints on loops first; -1 if all are placed. */
    int next_joint(int link, const std::vector<bool> &placed) const
    {
        int branch = -1;
        for (size_t j = 0; j < object_.joints.size(); j++) {
            const JointSpec &joint = object_.joints[j];
            if (placed[j] || (joint.a != link && joint.b != link))
                continue;
            if (in_loop(object_.truth, joint.a, joint.b))
                return static_cast<int>(j);
            if (branch < 0)
                branch = static_cast<int>(j);
        }
        return branch;
    }

    void walk(int root)
    {
        std::vector<bool> placed(object_.joints.size(), false);
        std::vector<int> path{root};
        seen_[static_cast<size_t>(root)] = true;
        while (!path.empty()) {
            int link = path.back();
            int j = next_joint(link, placed);
            if (j < 0) {
                path.pop_back();
                continue;
            }
            placed[static_cast<size_t>(j)] = true;
            JointSpec &joint = object_.joints[static_cast<size_t>(j)];
            int other = joint.a == link ? joint.b : joint.a;
            bool descend = !seen_[static_cast<size_t>(other)];
            if (descend) {
                seen_[static_cast<size_t>(other)] = true;
                entered_[static_cast<size_t>(other)] = true;
                path.push_back(other);
            }
            place(joint, link, other);
        }
    }

    void place(JointSpec &joint, int link, int other)
    {
        Slot from = next_slot(link);
        Slot to = next_slot(other);
        if (joint.given)
            return;
        joint.a = link;
        joint.b = other;
        joint.anchor_a_m = from.anchor_m;
        joint.anchor_b_m = to.anchor_m;
        joint.axis_rad = from.outward_rad;
        joint.angle_rad = wrap_angle(from.outward_rad - to.outward_rad + pi);
    }

    ObjectSpec &object_;
    std::vector<int> used_slots_;
    std::vector<bool> seen_;
    std::vector<bool> entered_; /* attached by its -x end, which is then its first slot */
};

std::string joint_text(const ObjectSpec &object, const JointSpec &joint)
{
    return std::string(joint.type == GRRL_REVOLUTE ? "revolute" : "prismatic") + " joint between " +
           object.links[static_cast<size_t>(joint.a)].name + " and " +
           object.links[static_cast<size_t>(joint.b)].name;
}

/* The joints on loops, each with the links of its loop as a mask. */
std::vector<bool> loop_joints(const ObjectSpec &object)
{
    std::vector<bool> on_loop;
    for (const JointSpec &joint : object.joints)
        on_loop.push_back(in_loop(object.truth, joint.a, joint.b));
    return on_loop;
}

std::string names_on_loops(const ObjectSpec &object, const std::vector<bool> &on_loop)
{
    std::string names;
    for (size_t i = 0; i < object.links.size(); i++) {
        bool found = false;
        for (size_t j = 0; j < object.joints.size(); j++) {
            bool ends = object.joints[j].a == static_cast<int>(i) ||
                        object.joints[j].b == static_cast<int>(i);
            found = found || (on_loop[j] && ends);
        }
        if (found)
            names += (names.empty() ? "" : ", ") + object.links[i].name;
    }
    return names;
}

/* Initial values for closing the loops: first a regular polygon, then random ones. */
std::vector<double> first_guess(const ObjectSpec &object, const std::vector<bool> &on_loop,
                                int attempt, Random &random)
{
    int corners = 0;
    for (size_t j = 0; j < on_loop.size(); j++)
        corners += on_loop[j] && !object.joints[j].given ? 1 : 0;
    std::vector<double> values(object.joints.size(), 0.0);
    for (size_t j = 0; j < values.size(); j++) {
        const JointSpec &joint = object.joints[j];
        if (joint.given)
            values[j] = random.uniform(joint.lower, joint.upper);
        else if (on_loop[j] && attempt == 0)
            values[j] = 2.0 * pi / corners;
        else if (on_loop[j])
            values[j] = random.uniform(-2.5, 2.5);
    }
    return values;
}

bool within_limits(const ObjectSpec &object, const std::vector<double> &values)
{
    for (size_t j = 0; j < values.size(); j++)
        if (values[j] < object.joints[j].lower || values[j] > object.joints[j].upper)
            return false;
    return true;
}

/* The size of the smaller of a joint's links in standard links, as a length and as a mass. */
struct Size {
    double length = 1.0;
    double mass = 1.0;
};

Size smaller_link(const ObjectSpec &object, const JointSpec &joint)
{
    const LinkSpec standard;
    Size least;
    bool first = true;
    for (int i : {joint.a, joint.b}) {
        const LinkSpec &link = object.links[static_cast<size_t>(i)];
        Size size{link.half_length_m / standard.half_length_m, link.mass_kg / standard.mass_kg};
        if (link.fixed || (!first && size.mass * size.length >= least.mass * least.length))
            continue;
        least = size;
        first = false;
    }
    return least;
}

void make_similar(const ObjectSpec &object, JointSpec &joint)
{
    Size size = smaller_link(object, joint);
    if (joint.type == GRRL_REVOLUTE) {
        joint.friction *= size.mass * size.length;
        return;
    }
    joint.friction *= size.mass;
    for (double *value : {&joint.lower, &joint.upper, &joint.initial_lower, &joint.initial_upper})
        *value *= size.length;
}

std::string scale_object(ObjectSpec &object, const ObjectScale &scale)
{
    for (const JointSpec &joint : object.joints)
        if (joint.given && scale.length != 1.0)
            return "joints with places of their own cannot follow links of another length";
    for (LinkSpec &link : object.links) {
        if (scale.length != 1.0)
            resize_link(link, scale.length, 1.0);
        link.features_min = std::max(3, static_cast<int>(scale.features * link.features_min + 0.5));
        link.features_max = std::max(3, static_cast<int>(scale.features * link.features_max + 0.5));
    }
    for (JointSpec &joint : object.joints) {
        joint.friction *= scale.friction;
        if (scale.similar && !joint.given)
            make_similar(object, joint);
    }
    return {};
}

/* Makes the closed configuration the zero of the joints whose geometry this file chose. */
void set_zero(ObjectSpec &object, const std::vector<bool> &on_loop,
              const std::vector<double> &values)
{
    for (size_t j = 0; j < values.size(); j++) {
        JointSpec &joint = object.joints[j];
        if (!on_loop[j])
            continue;
        if (!joint.given) {
            joint.angle_rad = wrap_angle(joint.angle_rad + values[j]);
            joint.friction *= loop_friction_share;
            continue;
        }
        double spread = (joint.initial_upper - joint.initial_lower) / 2.0;
        joint.initial_lower = std::max(joint.lower, values[j] - spread);
        joint.initial_upper = std::min(joint.upper, values[j] + spread);
    }
}

std::string immobile_joint(const ObjectSpec &object)
{
    Forest forest = spanning_forest(object);
    std::vector<double> values(object.joints.size(), 0.0);
    for (size_t j = 0; j < values.size(); j++)
        if (object.joints[j].given)
            values[j] = (object.joints[j].initial_lower + object.joints[j].initial_upper) / 2.0;
    if (!close_loops(object, forest, values))
        return "the loop does not stay closed";
    std::vector<bool> movable = movable_joints(object, forest, values);
    for (size_t j = 0; j < movable.size(); j++)
        if (!movable[j])
            return "the " + joint_text(object, object.joints[j]) + " cannot move";
    return {};
}

std::string close_object(ObjectSpec &object, const std::vector<bool> &on_loop)
{
    ObjectSpec hinged = object; /* every corner of a loop turns until the loop is closed */
    for (size_t j = 0; j < on_loop.size(); j++) {
        if (!on_loop[j] || hinged.joints[j].given)
            continue;
        hinged.joints[j].type = GRRL_REVOLUTE;
        hinged.joints[j].lower = -pi;
        hinged.joints[j].upper = pi;
    }
    Forest forest = spanning_forest(hinged);
    Random random(1, Stream::OBJECT); /* the same description always gives the same object */
    std::string immobile;
    std::optional<ObjectSpec> fallback;
    for (int attempt = 0; attempt < loop_attempts; attempt++) {
        std::vector<double> values = first_guess(hinged, on_loop, attempt, random);
        if (!close_loops(hinged, forest, values) || !within_limits(hinged, values))
            continue;
        ObjectSpec closed = object;
        set_zero(closed, on_loop, values);
        std::string problem = immobile_joint(closed);
        if (!problem.empty()) {
            immobile = problem;
            continue;
        }
        bool free = !links_overlap(hinged, link_poses(hinged, forest, values), 0.002);
        if (free || !fallback)
            fallback = closed;
        if (free)
            break;
    }
    if (fallback) {
        object = *fallback;
        return {};
    }
    std::string names = names_on_loops(object, on_loop);
    if (!immobile.empty())
        return "the loop through " + names + " closes but has no mobility: " + immobile +
               "; a planar loop needs at least 4 joints (3 if all are prismatic)";
    return "the loop through " + names +
           " cannot close: its links do not reach; no link may be longer than the others of its "
           "loop together, and the limits must allow a closed position";
}

} // namespace

std::string finish_object(ObjectSpec &object, const ObjectScale &scale)
{
    std::string problem = scale_object(object, scale);
    if (!problem.empty())
        return problem;
    Layout(object).run();
    std::vector<bool> on_loop = loop_joints(object);
    if (std::find(on_loop.begin(), on_loop.end(), true) == on_loop.end())
        return {};
    return close_object(object, on_loop);
}

} // namespace grrl_sim
