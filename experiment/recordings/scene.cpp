/* scene.cpp: random scenes, and the poses of their bodies over time. */
#include "scene.hpp"

#include <cmath>

#include "joint_error.hpp"
#include "random.hpp"

namespace grrl_experiment::recordings
{

using grrl_sim::Pose;
using grrl_sim::radians;
using grrl_sim::Random;
using grrl_sim::Vec2;

namespace
{

/* Share of a link's length by which two bodies without a joint must deviate from any joint. */
constexpr double least_error = 0.04;

/* When a hand approaches, pushes and leaves a lever. */
constexpr double touches_at = 0.3;
constexpr double lets_go_at = 0.7;

double smooth(double t)
{
    t = std::min(std::max(t, 0.0), 1.0);
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

Wave draw_wave(Random &random, double size)
{
    Wave wave;
    for (int i = 0; i < 2; i++) {
        wave.size[i] = size * random.uniform(0.3, 0.7) / (i + 1);
        wave.phase[i] = random.uniform(0.0, 2.0 * grrl_sim::pi);
        wave.cycles[i] = random.uniform(0.4, 0.8) * (i + 1);
    }
    return wave;
}

double draw_sign(Random &random)
{
    return random.below(2) == 0 ? -1.0 : 1.0;
}

Body draw_link(Random &random, double link_m)
{
    Body body;
    body.half_length_m = 0.5 * link_m * random.uniform(0.8, 1.0);
    body.half_width_m = link_m * random.uniform(0.12, 0.2);
    return body;
}

void move_freely(Random &random, Body &body, double size_m, double turn_rad)
{
    body.x_m = draw_wave(random, size_m);
    body.y_m = draw_wave(random, size_m);
    body.turn_rad = draw_wave(random, turn_rad);
}

/* A value that changes by `range` within the given time; a quarter of them change back. */
std::vector<Ramp> draw_ramps(Random &random, double begin, double end, double range)
{
    double size = draw_sign(random) * range;
    if (random.below(4) != 0) {
        double first = begin + random.uniform(0.0, 0.3) * (end - begin);
        return {{first, end - random.uniform(0.0, 0.3) * (end - first), size}};
    }
    double middle = begin + random.uniform(0.4, 0.6) * (end - begin);
    return {{begin, middle, size}, {middle, end, -size * random.uniform(0.6, 1.0)}};
}

/* A joint between the last two bodies. It moves by at least 20 degrees or 10% of a link, even if a
 * link is visible only late or early. */
void join(Random &random, Scene &scene, int a, grrl_joint_type type)
{
    Joint joint;
    joint.a = a;
    joint.b = a + 1;
    joint.type = type;
    const Body &first = scene.bodies[static_cast<size_t>(joint.a)];
    const Body &second = scene.bodies[static_cast<size_t>(joint.b)];
    if (type == GRRL_REVOLUTE) {
        joint.at_a_m = {first.half_length_m - 0.5 * first.half_width_m, 0.0};
        joint.at_b_m = {-second.half_length_m + 0.5 * second.half_width_m, 0.0};
        joint.angle_rad = random.uniform(-0.8, 0.8);
        joint.ramps = draw_ramps(random, 0.08, 0.92, radians(random.uniform(32.0, 90.0)));
    } else {
        double reach = random.uniform(0.18, 0.4) * scene.link_m;
        joint.at_a_m = {first.half_length_m + 0.6 * second.half_length_m, 0.0};
        joint.ramps = draw_ramps(random, 0.08, 0.92, reach);
    }
    scene.joints.push_back(joint);
}

/* A chain on the table; the first link moves, too. */
void make_chain(Random &random, Scene &scene, std::initializer_list<grrl_joint_type> types)
{
    double link_m = (types.size() > 1 ? 0.75 : 1.0) * scene.link_m;
    scene.bodies.push_back(draw_link(random, link_m));
    Body &base = scene.bodies.back();
    double half = types.size() > 1 ? 0.8 : 0.5;
    base.start = {scene.link_m * Vec2{-half, random.uniform(-0.3, 0.3)}, random.uniform(-0.3, 0.3)};
    move_freely(random, base, 0.25 * scene.link_m, radians(random.uniform(15.0, 40.0)));
    for (grrl_joint_type type : types) {
        scene.bodies.push_back(draw_link(random, link_m));
        join(random, scene, static_cast<int>(scene.bodies.size()) - 2, type);
    }
}

/* A link on the ground, which has points near the joint. */
void make_grounded(Random &random, Scene &scene, grrl_joint_type type)
{
    scene.bodies[0] = draw_link(random, scene.link_m);
    scene.bodies[0].start = {scene.link_m * Vec2{-0.7, random.uniform(-0.3, 0.3)},
                             random.uniform(-0.4, 0.4)};
    scene.bodies.push_back(draw_link(random, scene.link_m));
    join(random, scene, 0, type);
}

void make_independent(Random &random, Scene &scene, int count)
{
    for (int i = 0; i < count; i++) {
        Body body = draw_link(random, 0.8 * scene.link_m);
        body.start = {scene.link_m * Vec2{i % 2 == 0 ? -0.8 : 0.8, i < 2 ? -0.5 : 0.5},
                      random.uniform(-grrl_sim::pi, grrl_sim::pi)};
        move_freely(random, body, random.uniform(0.25, 0.5) * scene.link_m,
                    radians(random.uniform(20.0, 70.0)));
        scene.bodies.push_back(body);
    }
}

void make_crossing(Random &random, Scene &scene)
{
    Body body = draw_link(random, 0.6 * scene.link_m);
    Vec2 way = 2.4 * scene.link_m * grrl_sim::direction(random.uniform(-0.4, 0.4));
    way = draw_sign(random) * way;
    body.start = {-0.5 * way, random.uniform(-0.4, 0.4)};
    body.cross_x_m = {0.0, 1.0, way.x};
    body.cross_y_m = {0.0, 1.0, way.y};
    scene.bodies.push_back(body);
}

void make_nearer(Random &random, Scene &scene)
{
    Body body = draw_link(random, scene.link_m);
    body.half_width_m *= 2.0;
    move_freely(random, body, 0.1 * scene.link_m, radians(5.0));
    body.growth = {0.05, 0.95, random.uniform(0.2, 0.35)};
    scene.bodies.push_back(body);
}

/* Boxes that turn out of the plane while they move. */
void make_solids(Random &random, Scene &scene)
{
    make_independent(random, scene, 2);
    for (size_t b = 1; b < scene.bodies.size(); b++) {
        Body &body = scene.bodies[b];
        body.half_width_m *= 2.0;
        body.half_depth_m = body.half_width_m;
        body.pitch_rad = draw_wave(random, radians(random.uniform(15.0, 40.0)));
        body.yaw_rad = draw_wave(random, radians(random.uniform(15.0, 40.0)));
    }
}

/* A lever on the ground, and a hand that turns it, lets go and leaves in a straight line. */
void make_hand(Random &random, Scene &scene)
{
    make_grounded(random, scene, GRRL_REVOLUTE);
    scene.joints[0].ramps = {
        {touches_at, lets_go_at, draw_sign(random) * radians(random.uniform(30.0, 80.0))}};
    Body hand;
    hand.half_length_m = 0.2 * scene.link_m;
    hand.half_width_m = 0.15 * scene.link_m;
    hand.carried = true;
    Vec2 from = random.uniform(0.8, 1.2) * scene.link_m * grrl_sim::direction(random.uniform(0, 6));
    Vec2 to = random.uniform(0.8, 1.2) * scene.link_m * grrl_sim::direction(random.uniform(0, 6));
    hand.start.position = from;
    hand.start.angle = random.uniform(-grrl_sim::pi, grrl_sim::pi);
    hand.cross_x_m = {lets_go_at, 1.0, to.x};
    hand.cross_y_m = {lets_go_at, 1.0, to.y};
    hand.turn_rad = draw_wave(random, radians(random.uniform(5.0, 30.0)));
    scene.bodies.push_back(hand);
}

Scene draw(Object object, double link_m, Random &random)
{
    Scene scene;
    scene.link_m = link_m;
    scene.bodies.resize(1);
    switch (object) {
    case Object::R:
        make_chain(random, scene, {GRRL_REVOLUTE});
        break;
    case Object::P:
        make_chain(random, scene, {GRRL_PRISMATIC});
        break;
    case Object::RR:
        make_chain(random, scene, {GRRL_REVOLUTE, GRRL_REVOLUTE});
        break;
    case Object::RP:
        make_chain(random, scene, {GRRL_REVOLUTE, GRRL_PRISMATIC});
        break;
    case Object::DOOR:
        make_grounded(random, scene, GRRL_REVOLUTE);
        break;
    case Object::DRAWER:
        make_grounded(random, scene, GRRL_PRISMATIC);
        break;
    case Object::TWO:
        make_independent(random, scene, 2);
        break;
    case Object::THREE:
        make_independent(random, scene, 3);
        break;
    case Object::FOUR:
        make_independent(random, scene, 4);
        break;
    case Object::CROSSING:
        make_crossing(random, scene);
        break;
    case Object::NEARER:
        make_nearer(random, scene);
        break;
    case Object::SOLIDS:
        make_solids(random, scene);
        break;
    case Object::HAND:
        make_hand(random, scene);
        break;
    }
    return scene;
}

bool joined(const Scene &scene, size_t a, size_t b)
{
    for (const Joint &joint : scene.joints)
        if (joint.a == static_cast<int>(a) && joint.b == static_cast<int>(b))
            return true;
    return false;
}

/* The smaller RMS error of the best pivot and the best axis for the motion of b in a; angles are
 * converted at half a link's length. */
double error_of_a_joint(const Scene &scene, size_t a, size_t b)
{
    std::vector<Pose> poses;
    for (int i = 0; i < 25; i++) {
        std::vector<Placed> placed = scene.at(i / 24.0);
        poses.push_back(compose(inverse(placed[a].pose), placed[b].pose));
    }
    JointErrors errors = joint_errors(poses);
    return std::min(errors.pivot_m,
                    std::hypot(errors.line_m, 0.5 * scene.link_m * errors.turn_rad));
}

/* Whether everything stays in the image, including the corners of each body. */
bool is_in_view(const Scene &scene)
{
    for (int i = 0; i < 25; i++) {
        std::vector<Placed> placed = scene.at(i / 24.0);
        for (size_t b = 1; b < placed.size(); b++) {
            for (int corner = 0; corner < 4; corner++) {
                const Body &body = scene.bodies[b];
                Vec2 at{(corner % 2 == 0 ? -1.0 : 1.0) * body.half_length_m,
                        (corner < 2 ? -1.0 : 1.0) * body.half_width_m};
                at = transform(placed[b].pose, at);
                if (std::abs(at.x) > 0.5 * table_links[0] * scene.link_m ||
                    std::abs(at.y) > 0.5 * table_links[1] * scene.link_m)
                    return false;
            }
        }
    }
    return true;
}

/* Whether no pair without a joint looks joined. */
bool is_clear(const Scene &scene)
{
    if (!is_in_view(scene))
        return false;
    for (size_t b = 1; b < scene.bodies.size(); b++)
        for (size_t a = 0; a < b; a++)
            if (!joined(scene, a, b) && error_of_a_joint(scene, a, b) < least_error * scene.link_m)
                return false;
    return true;
}

Pose free_pose(const Scene &scene, const std::vector<Placed> &before, const Body &body, double t)
{
    Vec2 moved{body.x_m.at(t) + body.cross_x_m.at(t), body.y_m.at(t) + body.cross_y_m.at(t)};
    Pose pose{body.start.position + moved, body.start.angle + body.turn_rad.at(t)};
    if (!body.carried)
        return pose;
    const Body &lever = scene.bodies[1];
    Vec2 end = grrl_sim::transform(before[1].pose, {lever.half_length_m, 0.0});
    double away = 1.0 - smooth(t / touches_at);
    pose.position = end + away * body.start.position + moved;
    return pose;
}

} // namespace

const std::vector<NamedObject> &all_objects()
{
    static const std::vector<NamedObject> objects = {
        {Object::R, Kind::MECHANISM, "R", "two links with a hinge"},
        {Object::P, Kind::MECHANISM, "P", "two links that slide"},
        {Object::RR, Kind::MECHANISM, "RR", "three links, two hinges"},
        {Object::RP, Kind::MECHANISM, "RP", "three links, a hinge and a slide"},
        {Object::DOOR, Kind::MECHANISM, "door", "a link hinged to the ground"},
        {Object::DRAWER, Kind::MECHANISM, "drawer", "a link that slides on the ground"},
        {Object::TWO, Kind::INDEPENDENT, "two", "two independent bodies"},
        {Object::THREE, Kind::INDEPENDENT, "three", "three of them"},
        {Object::FOUR, Kind::INDEPENDENT, "four", "four of them"},
        {Object::CROSSING, Kind::INDEPENDENT, "crossing", "a body crosses the picture straight"},
        {Object::NEARER, Kind::INDEPENDENT, "nearer", "a body whose picture grows"},
        {Object::SOLIDS, Kind::INDEPENDENT, "solids", "two boxes that turn out of the plane"},
        {Object::HAND, Kind::HAND, "hand", "a door, and a hand that lets go of it"},
    };
    return objects;
}

double Ramp::at(double t) const
{
    return size * smooth((t - begin) / (end - begin));
}

double Wave::at(double t) const
{
    double sum = 0.0;
    for (int i = 0; i < 2; i++) {
        double turn = 2.0 * grrl_sim::pi * cycles[i] * t;
        sum += size[i] * (std::sin(turn + phase[i]) - std::sin(phase[i]));
    }
    return sum;
}

double Joint::value(double t) const
{
    double sum = 0.0;
    for (const Ramp &ramp : ramps)
        sum += ramp.at(t);
    return sum;
}

Place transform(const Placed &placed, const Place &in_body)
{
    Vec2 across_and_up{in_body.table_m.y, in_body.height_m};
    across_and_up = rotate(across_and_up, placed.pitch_rad);
    Vec2 along_and_up = rotate(Vec2{in_body.table_m.x, across_and_up.y}, placed.yaw_rad);
    Vec2 flat{along_and_up.x, across_and_up.x};
    return {transform(placed.pose, placed.scale * flat), placed.scale * along_and_up.y};
}

std::vector<Placed> Scene::at(double t) const
{
    std::vector<Placed> placed;
    for (size_t i = 0; i < bodies.size(); i++) {
        placed.push_back({free_pose(*this, placed, bodies[i], t), 1.0 + bodies[i].growth.at(t),
                          bodies[i].pitch_rad.at(t), bodies[i].yaw_rad.at(t)});
        for (const Joint &joint : joints) {
            if (joint.b != static_cast<int>(i))
                continue;
            bool turns = joint.type == GRRL_REVOLUTE;
            double value = joint.value(t);
            Pose in_a{joint.at_a_m + (turns ? Vec2{} : Vec2{value, 0.0}),
                      joint.angle_rad + (turns ? value : 0.0)};
            in_a.position = in_a.position - rotate(joint.at_b_m, in_a.angle);
            placed[i].pose = compose(placed[static_cast<size_t>(joint.a)].pose, in_a);
        }
    }
    return placed;
}

Scene make_scene(Object object, double link_m, uint64_t seed)
{
    bool close = object == Object::CROSSING || object == Object::NEARER || object == Object::HAND;
    Random random(seed, grrl_sim::Stream::OBJECT);
    Scene scene = draw(object, link_m, random);
    for (int i = 0; i < 1000 && !close && !is_clear(scene); i++)
        scene = draw(object, link_m, random);
    return scene;
}

} // namespace grrl_experiment::recordings
