/* Places the object, pushes it, and lets it come to rest. */
#include "world.hpp"

#include <sstream>

#include "kinematics.hpp"
#include "physics.hpp"
#include "placement.hpp"

namespace grrl_sim
{

namespace
{

constexpr int steps_per_frame = 4;
constexpr double back_off_step_m = 0.005;
constexpr double max_back_off_m = 0.3;
constexpr double landing_clearance_m = 0.001;
constexpr double blocked_after_s = 0.3;
constexpr double at_rest_m_s = 0.0005;
constexpr double max_settle_s = 1.0;

enum class Phase { REST, PUSHING, SETTLING };

} // namespace

struct World::Impl {
    ObjectSpec object;
    WorldParams params;
    Random placing;
    Random pushing;
    Random noise;
    std::vector<Pose> start;
    Physics physics;
    Tracker tracker;
    Phase phase = Phase::REST;
    uint64_t frames = 0;
    std::vector<double> least; /* smallest value of each joint so far */
    std::vector<double> greatest;
    PushCommand command;
    PushResult result;
    double line_m = 0.0; /* from where the finger came down to the end */
    double contact_m = 0.0;
    double progress_m = 0.0; /* travel and time of the last progress */
    double progress_s = 0.0;
    double settling_s = 0.0;

    Impl(const ObjectSpec &o, const WorldParams &p, uint64_t seed)
        : object(o), params(p), placing(seed, Stream::OBJECT), pushing(seed, Stream::PUSH),
          noise(seed, Stream::NOISE), start(random_poses(o, p.table_m, placing)),
          physics(o, start, p.table_friction, finger_radius_m),
          tracker(o, p.tracker, p.table_m, start, placing)
    {
        for (size_t j = 0; j < object.joints.size(); j++)
            least.push_back(physics.joint_value(static_cast<int>(j)));
        greatest = least;
    }

    Impl(const Impl &other, uint64_t seed)
        : object(other.object), params(other.params), placing(seed, Stream::OBJECT),
          pushing(seed, Stream::PUSH), noise(seed, Stream::NOISE), start(other.physics.poses()),
          physics(object, start, params.table_friction, finger_radius_m), tracker(other.tracker),
          frames(other.frames), least(other.least), greatest(other.greatest)
    {
        physics.keep_levels(other.physics);
    }

    void start_push();
    void draw_friction();
    bool free_for_finger(Vec2 point, const std::vector<Pose> &poses) const;
    void step();
    void check_finger();
    void finish(PushReason reason);
    void record_joints();
};

void World::Impl::draw_friction()
{
    auto factors = [this](size_t n) {
        std::vector<double> drawn;
        for (size_t i = 0; i < n; i++)
            drawn.push_back(1.0 + params.friction_spread * pushing.uniform(-1.0, 1.0));
        return drawn;
    };
    std::vector<double> links = factors(object.links.size());
    physics.scale_friction(links, factors(object.joints.size()));
}

bool World::Impl::free_for_finger(Vec2 point, const std::vector<Pose> &poses) const
{
    for (size_t i = 0; i < poses.size(); i++)
        if (!object.links[i].fixed && distance(link_rectangle(object.links[i], poses[i]), point) <
                                          finger_radius_m + landing_clearance_m)
            return false;
    return true;
}

void World::Impl::start_push()
{
    draw_friction();
    Vec2 line = command.end_m - command.start_m;
    double turn = params.push_direction_sigma_rad * pushing.normal();
    double offset = params.contact_offset_sigma_m * pushing.normal();
    Vec2 along = rotate((1.0 / length(line)) * line, turn);
    Vec2 from = command.start_m + offset * Vec2{-along.y, along.x};
    std::vector<Pose> poses = physics.poses();
    double back = 0.0;
    while (back <= max_back_off_m && !free_for_finger(from - back * along, poses))
        back += back_off_step_m;
    result = PushResult{};
    result.from_m = from - back * along;
    result.to_m = result.from_m;
    if (back > max_back_off_m)
        return finish(PushReason::BLOCKED);
    line_m = length(line) + back;
    progress_m = 0.0;
    progress_s = 0.0;
    physics.lower_finger(result.from_m, along, command.speed_m_s, command.force_limit_n);
    phase = Phase::PUSHING;
}

void World::Impl::finish(PushReason reason)
{
    result.reason = reason;
    if (physics.finger_position())
        result.to_m = *physics.finger_position();
    physics.lift_finger();
    settling_s = 0.0;
    phase = Phase::SETTLING;
}

void World::Impl::check_finger()
{
    result.duration_s += step_s;
    double travel = physics.finger_travel_m();
    if (!result.touched && physics.finger_touches()) {
        result.touched = true;
        contact_m = travel;
    }
    if (result.touched)
        result.travelled_m = travel - contact_m;
    /* Progress means a quarter of what the commanded speed would give, at most 0.5 mm. */
    double ahead = std::min(0.0005, 0.25 * command.speed_m_s * blocked_after_s);
    if (travel > progress_m + ahead) {
        progress_m = travel;
        progress_s = result.duration_s;
    }
    if (result.touched && result.travelled_m >= command.travel_m)
        finish(PushReason::REACHED);
    else if (travel >= line_m)
        finish(result.touched ? PushReason::REACHED : PushReason::MISSED);
    else if (result.duration_s >= command.timeout_s)
        finish(PushReason::TIMEOUT);
    else if (result.duration_s - progress_s >= blocked_after_s)
        finish(PushReason::BLOCKED);
}

void World::Impl::step()
{
    physics.step();
    if (phase == Phase::PUSHING) {
        check_finger();
    } else {
        settling_s += step_s;
        if (physics.greatest_speed() < at_rest_m_s || settling_s >= max_settle_s) {
            physics.stop_links();
            phase = Phase::REST;
        }
    }
}

void World::Impl::record_joints()
{
    for (size_t j = 0; j < least.size(); j++) {
        double value = physics.joint_value(static_cast<int>(j));
        least[j] = std::min(least[j], value);
        greatest[j] = std::max(greatest[j], value);
    }
}

std::string check_world(const WorldParams &params)
{
    const struct {
        const char *name;
        double value;
        double least;
        double most;
    } ranges[] = {
        {"table width (m)", params.table_m.x, 0.5, 20.0},
        {"table height (m)", params.table_m.y, 0.5, 20.0},
        {"table friction", params.table_friction, 0.05, 2.0},
        {"contact offset sigma (m)", params.contact_offset_sigma_m, 0.0, 0.1},
        {"push direction sigma (rad)", params.push_direction_sigma_rad, 0.0, 1.0},
        {"friction spread", params.friction_spread, 0.0, 0.9},
        {"noise sigma (m)", params.tracker.noise_sigma_m, 0.0, 0.1},
        {"drop-out probability", params.tracker.dropout_probability, 0.0, 1.0},
        {"outlier probability", params.tracker.outlier_probability, 0.0, 1.0},
        {"outlier reach (m)", params.tracker.outlier_reach_m, 0.0, 1.0},
        {"background features", static_cast<double>(params.tracker.background_features), 0.0,
         static_cast<double>(GRRL_MAX_FEATURES)},
        {"feature distance (m)", params.tracker.feature_distance_m, 0.0, 0.1},
    };
    for (const auto &range : ranges) {
        if (range.value >= range.least && range.value <= range.most) /* false for NaN */
            continue;
        std::ostringstream message;
        message << range.name << " is " << range.value << " but must be from " << range.least
                << " to " << range.most;
        return message.str();
    }
    return {};
}

World::World(const ObjectSpec &object, const WorldParams &params, uint64_t seed)
    : impl_(std::make_unique<Impl>(object, params, seed))
{
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

World World::copy(uint64_t seed) const
{
    return World(std::make_unique<Impl>(*impl_, seed));
}

World::~World() = default;
World::World(World &&) noexcept = default;
World &World::operator=(World &&) noexcept = default;

std::string World::begin_push(const PushCommand &command)
{
    if (impl_->phase != Phase::REST)
        return "a push is in progress; wait for its result";
    std::string problem = check_push(command, impl_->params.table_m);
    if (!problem.empty())
        return problem;
    impl_->command = command;
    impl_->start_push();
    return {};
}

bool World::step_frame()
{
    impl_->frames++;
    if (impl_->phase == Phase::REST) /* dry friction: nothing moves by itself */
        return false;
    for (int i = 0; i < steps_per_frame && impl_->phase != Phase::REST; i++)
        impl_->step();
    impl_->record_joints();
    return impl_->phase != Phase::REST;
}

const PushResult &World::push_result() const
{
    return impl_->result;
}

void World::observe(Frame &frame)
{
    frame.index = impl_->frames;
    frame.time_s = time_s();
    impl_->tracker.observe(impl_->physics.poses(), impl_->noise, frame);
}

double World::time_s() const
{
    return static_cast<double>(impl_->frames) * frame_s;
}

uint64_t World::state_hash() const
{
    return impl_->physics.hash();
}

const ObjectSpec &World::object() const
{
    return impl_->object;
}

const Tracker &World::tracker() const
{
    return impl_->tracker;
}

std::vector<Pose> World::true_poses() const
{
    return impl_->physics.poses();
}

double World::true_joint_value(int joint) const
{
    return impl_->physics.joint_value(joint);
}

double World::true_loop_gap_m(int joint) const
{
    return impl_->physics.loop_gap_m(joint);
}

double World::true_joint_range(int joint) const
{
    size_t j = static_cast<size_t>(joint);
    return impl_->greatest[j] - impl_->least[j];
}

std::optional<Vec2> World::finger_position() const
{
    return impl_->physics.finger_position();
}

} // namespace grrl_sim
