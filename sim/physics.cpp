/* The Box2D world: bodies, joints, friction and the finger. */
#include "physics.hpp"

#include <cstring>

#include <box2d/box2d.h>

#include "kinematics.hpp"

namespace grrl_sim
{

namespace
{

constexpr double units_per_metre = 100.0;
constexpr double gravity_m_s2 = 9.81;
constexpr float contact_friction = 0.3f;
constexpr double finger_mass_kg = 0.2;
constexpr int velocity_iterations = 12;
constexpr int position_iterations = 4;

float units(double metres)
{
    return static_cast<float>(metres * units_per_metre);
}
b2Vec2 units(Vec2 v)
{
    return {units(v.x), units(v.y)};
}
/* 1 N is 100 kg cm/s^2, 1 N m is 10000 kg cm^2/s^2. */
float force_units(double newtons)
{
    return static_cast<float>(newtons * units_per_metre);
}
float torque_units(double newton_metres)
{
    return static_cast<float>(newton_metres * units_per_metre * units_per_metre);
}
double metres(float u)
{
    return static_cast<double>(u) / units_per_metre;
}
Vec2 metres(b2Vec2 v)
{
    return {metres(v.x), metres(v.y)};
}
size_t index(int i)
{
    return static_cast<size_t>(i);
}

/* Links that cross one another at the start are on different levels and stay there. */
class Levels : public b2ContactFilter
{
public:
    bool ShouldCollide(b2Fixture *a, b2Fixture *b) override
    {
        uintptr_t link_a = a->GetUserData().pointer; /* 0 is the finger, else a link from 1 */
        uintptr_t link_b = b->GetUserData().pointer;
        return link_a == 0 || link_b == 0 || (apart[link_a - 1] >> (link_b - 1) & 1u) == 0;
    }

    std::vector<uint32_t> apart; /* bit k of apart[i]: links i and k */
};

} // namespace

struct Physics::Bodies {
    ObjectSpec object;
    double table_friction;
    double finger_radius_m;
    Levels levels;
    b2World world{b2Vec2(0.0f, 0.0f)};
    b2Body *table = nullptr;
    std::vector<b2Body *> links;
    std::vector<b2Joint *> joints;
    std::vector<b2FrictionJoint *> table_joints; /* two a link, none for fixed ones */
    std::vector<int> table_joint_link;
    b2Body *finger = nullptr;
    b2PrismaticJoint *guide = nullptr;

    void add_link(int i, const Pose &pose);
    void add_table_friction(int i);
    void add_joint(const JointSpec &joint);
    void add_levels(const std::vector<Pose> &poses);
};

void Physics::Bodies::add_link(int i, const Pose &pose)
{
    const LinkSpec &link = object.links[index(i)];
    b2BodyDef def;
    def.type = link.fixed ? b2_staticBody : b2_dynamicBody;
    def.position = units(pose.position);
    def.angle = static_cast<float>(pose.angle);
    links.push_back(world.CreateBody(&def));
    if (link.fixed)
        return;
    b2PolygonShape shape;
    shape.SetAsBox(units(link.half_length_m), units(link.half_width_m));
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.friction = contact_friction;
    fixture.density = static_cast<float>(link.mass_kg) /
                      (4.0f * units(link.half_length_m) * units(link.half_width_m));
    fixture.userData.pointer = static_cast<uintptr_t>(i + 1);
    links.back()->CreateFixture(&fixture);
    add_table_friction(i);
}

void Physics::Bodies::add_table_friction(int i)
{
    for (double side : {-0.5, 0.5}) { /* a quarter of the length from the centre */
        b2FrictionJointDef def;
        Vec2 local{side * object.links[index(i)].half_length_m, 0.0};
        def.Initialize(table, links[index(i)], links[index(i)]->GetWorldPoint(units(local)));
        table_joints.push_back(static_cast<b2FrictionJoint *>(world.CreateJoint(&def)));
        table_joint_link.push_back(i);
    }
}

void Physics::Bodies::add_joint(const JointSpec &joint)
{
    b2Body *a = links[index(joint.a)];
    b2Body *b = links[index(joint.b)];
    double turn = static_cast<double>(b->GetAngle() - a->GetAngle());
    /* Box2D does not wrap angles, so whole turns between a and b belong to the reference. */
    double reference = turn - wrap_angle(turn - joint.angle_rad);
    if (joint.type == GRRL_REVOLUTE) {
        b2RevoluteJointDef def;
        def.bodyA = a;
        def.bodyB = b;
        def.localAnchorA = units(joint.anchor_a_m);
        def.localAnchorB = units(joint.anchor_b_m);
        def.referenceAngle = static_cast<float>(reference);
        def.enableLimit = true;
        def.lowerAngle = static_cast<float>(joint.lower);
        def.upperAngle = static_cast<float>(joint.upper);
        def.enableMotor = true; /* at speed 0: Coulomb friction */
        joints.push_back(world.CreateJoint(&def));
    } else {
        b2PrismaticJointDef def;
        def.bodyA = a;
        def.bodyB = b;
        def.localAnchorA = units(joint.anchor_a_m);
        def.localAnchorB = units(joint.anchor_b_m);
        Vec2 axis = direction(joint.axis_rad);
        def.localAxisA.Set(static_cast<float>(axis.x), static_cast<float>(axis.y));
        def.referenceAngle = static_cast<float>(reference);
        def.enableLimit = true;
        def.lowerTranslation = units(joint.lower);
        def.upperTranslation = units(joint.upper);
        def.enableMotor = true;
        joints.push_back(world.CreateJoint(&def));
    }
}

void Physics::Bodies::add_levels(const std::vector<Pose> &poses)
{
    size_t n = object.links.size();
    levels.apart.assign(n, 0);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            if (i != k && overlap(link_rectangle(object.links[i], poses[i]),
                                  link_rectangle(object.links[k], poses[k]), 0.0))
                levels.apart[i] |= UINT32_C(1) << k;
    world.SetContactFilter(&levels);
}

Physics::Physics(const ObjectSpec &object, const std::vector<Pose> &poses, double table_friction,
                 double finger_radius_m)
    : bodies_(std::make_unique<Bodies>())
{
    bodies_->object = object;
    bodies_->table_friction = table_friction;
    bodies_->finger_radius_m = finger_radius_m;
    bodies_->world.SetAllowSleeping(false);
    bodies_->world.SetContinuousPhysics(false); /* no body here is fast or thin */
    b2BodyDef table;
    bodies_->table = bodies_->world.CreateBody(&table);
    for (size_t i = 0; i < object.links.size(); i++)
        bodies_->add_link(static_cast<int>(i), poses[i]);
    for (const JointSpec &joint : object.joints)
        bodies_->add_joint(joint);
    bodies_->add_levels(poses);
    scale_friction(std::vector<double>(object.links.size(), 1.0),
                   std::vector<double>(object.joints.size(), 1.0));
}

Physics::~Physics() = default;

void Physics::keep_levels(const Physics &other)
{
    bodies_->levels.apart = other.bodies_->levels.apart;
}

void Physics::scale_friction(const std::vector<double> &links, const std::vector<double> &joints)
{
    for (size_t t = 0; t < bodies_->table_joints.size(); t++) {
        size_t i = index(bodies_->table_joint_link[t]);
        double newtons = bodies_->table_friction * bodies_->object.links[i].mass_kg * gravity_m_s2;
        bodies_->table_joints[t]->SetMaxForce(force_units(links[i] * newtons / 2.0));
    }
    for (size_t j = 0; j < bodies_->joints.size(); j++) {
        double friction = joints[j] * bodies_->object.joints[j].friction;
        if (bodies_->object.joints[j].type == GRRL_REVOLUTE)
            static_cast<b2RevoluteJoint *>(bodies_->joints[j])
                ->SetMaxMotorTorque(torque_units(friction));
        else
            static_cast<b2PrismaticJoint *>(bodies_->joints[j])
                ->SetMaxMotorForce(force_units(friction));
    }
}

void Physics::lower_finger(Vec2 at, Vec2 along, double speed_m_s, double force_n)
{
    b2BodyDef def;
    def.type = b2_dynamicBody;
    def.position = units(at);
    bodies_->finger = bodies_->world.CreateBody(&def);
    b2CircleShape shape;
    shape.m_radius = units(bodies_->finger_radius_m);
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.friction = contact_friction;
    fixture.density =
        static_cast<float>(finger_mass_kg) / (b2_pi * shape.m_radius * shape.m_radius);
    bodies_->finger->CreateFixture(&fixture);
    b2PrismaticJointDef guide;
    b2Vec2 axis(static_cast<float>(along.x), static_cast<float>(along.y));
    guide.Initialize(bodies_->table, bodies_->finger, bodies_->finger->GetPosition(), axis);
    guide.enableMotor = true;
    guide.motorSpeed = units(speed_m_s);
    guide.maxMotorForce = force_units(force_n);
    bodies_->guide = static_cast<b2PrismaticJoint *>(bodies_->world.CreateJoint(&guide));
}

void Physics::lift_finger()
{
    if (bodies_->finger != nullptr)
        bodies_->world.DestroyBody(bodies_->finger); /* this also destroys its guide */
    bodies_->finger = nullptr;
    bodies_->guide = nullptr;
}

bool Physics::finger_touches() const
{
    if (bodies_->finger == nullptr)
        return false;
    for (b2ContactEdge *edge = bodies_->finger->GetContactList(); edge != nullptr;
         edge = edge->next)
        if (edge->contact->IsTouching())
            return true;
    return false;
}

double Physics::finger_travel_m() const
{
    return bodies_->guide == nullptr ? 0.0 : metres(bodies_->guide->GetJointTranslation());
}

std::optional<Vec2> Physics::finger_position() const
{
    if (bodies_->finger == nullptr)
        return std::nullopt;
    return metres(bodies_->finger->GetPosition());
}

void Physics::step()
{
    bodies_->world.Step(static_cast<float>(step_s), velocity_iterations, position_iterations);
}

double Physics::greatest_speed() const
{
    double greatest = 0.0;
    for (size_t i = 0; i < bodies_->links.size(); i++) {
        double turning = static_cast<double>(std::abs(bodies_->links[i]->GetAngularVelocity()));
        double speed = length(metres(bodies_->links[i]->GetLinearVelocity())) +
                       turning * bodies_->object.links[i].half_length_m;
        greatest = std::max(greatest, speed);
    }
    return greatest;
}

void Physics::stop_links()
{
    for (b2Body *link : bodies_->links) {
        link->SetLinearVelocity(b2Vec2(0.0f, 0.0f));
        link->SetAngularVelocity(0.0f);
    }
}

std::vector<Pose> Physics::poses() const
{
    std::vector<Pose> poses;
    poses.reserve(bodies_->links.size());
    for (const b2Body *link : bodies_->links)
        poses.push_back({metres(link->GetPosition()), static_cast<double>(link->GetAngle())});
    return poses;
}

double Physics::joint_value(int joint) const
{
    const b2Joint *box2d_joint = bodies_->joints[index(joint)];
    if (bodies_->object.joints[index(joint)].type == GRRL_REVOLUTE)
        return static_cast<double>(
            static_cast<const b2RevoluteJoint *>(box2d_joint)->GetJointAngle());
    return metres(static_cast<const b2PrismaticJoint *>(box2d_joint)->GetJointTranslation());
}

double Physics::loop_gap_m(int joint) const
{
    b2Joint *box2d_joint = bodies_->joints[index(joint)];
    Vec2 gap = metres(box2d_joint->GetAnchorB() - box2d_joint->GetAnchorA());
    const JointSpec &spec = bodies_->object.joints[index(joint)];
    if (spec.type == GRRL_REVOLUTE)
        return length(gap);
    double axis = spec.axis_rad + static_cast<double>(bodies_->links[index(spec.a)]->GetAngle());
    return std::abs(cross(direction(axis), gap));
}

uint64_t Physics::hash() const
{
    uint64_t hash = UINT64_C(14695981039346656037); /* FNV-1a */
    auto add = [&hash](float value) {
        unsigned char bytes[sizeof value];
        std::memcpy(bytes, &value, sizeof value);
        for (unsigned char byte : bytes)
            hash = (hash ^ byte) * UINT64_C(1099511628211);
    };
    for (const b2Body *body = bodies_->world.GetBodyList(); body != nullptr;
         body = body->GetNext()) {
        add(body->GetPosition().x);
        add(body->GetPosition().y);
        add(body->GetAngle());
        add(body->GetLinearVelocity().x);
        add(body->GetLinearVelocity().y);
        add(body->GetAngularVelocity());
    }
    return hash;
}

} // namespace grrl_sim
