/*
 * world.hpp: the table with the object, the finger that pushes it and the camera above.
 *
 * Planar, seen from above, with dry friction everywhere (Box2D). No two pushes have the same
 * result: contact and direction vary a little, and every friction changes from push to push. The
 * same seed and commands give the same run, bit for bit.
 *
 * Order of calls: the constructor, then begin_push, then step_frame until it returns false; observe
 * whenever a frame is needed.
 */
#ifndef GRRL_SIM_WORLD_HPP
#define GRRL_SIM_WORLD_HPP

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "object.hpp"
#include "push.hpp"
#include "tracker.hpp"

namespace grrl_sim
{

constexpr double frame_s = 1.0 / 30.0;

struct WorldParams {
    Vec2 table_m{2.0,
                 1.6}; /* centred on the origin; large enough for a chain of 8 links of 0.13 m */
    double table_friction = 0.4; /* Coulomb, between the table and every link */
    double contact_offset_sigma_m = 0.005;
    double push_direction_sigma_rad = radians(5.0);
    double friction_spread = 0.2; /* each friction varies by up to this share from push to push */
    TrackerParams tracker;
};

/* Empty if the parameters are valid, else which one is not and what would be right. */
std::string check_world(const WorldParams &params);

class World
{
public:
    /* Starts with a random configuration of the object at a random place; the parameters must pass
     * check_world. */
    World(const ObjectSpec &object, const WorldParams &params, uint64_t seed);
    ~World();
    World(World &&) noexcept;

    /* A copy of the current scene, at rest; its pushes and frames use the noise of another seed. It
     * serves to try out pushes: this world does not change. */
    World copy(uint64_t seed) const;

    World &operator=(World &&) noexcept;

    /* Starts a push. Returns why it cannot (check_push, or one is in progress), or
     * an empty text. */
    std::string begin_push(const PushCommand &command);

    /* Advances 1/30 s. Returns whether a push is in progress or the object is still moving. */
    bool step_frame();

    /* The result of the last completed push. */
    const PushResult &push_result() const;

    /* Fills in what the camera sees now; every call draws fresh noise. */
    void observe(Frame &frame);

    double time_s() const;

    /* Hash of every position and velocity, bit for bit: equal runs have equal hashes. */
    uint64_t state_hash() const;

    /* The truth, for the supervisor, tests and pictures; not part of a frame. */
    const ObjectSpec &object() const;
    const Tracker &tracker() const;
    std::vector<Pose> true_poses() const;
    double true_joint_value(int joint) const;
    double true_loop_gap_m(int joint) const;     /* between the anchors that should coincide */
    double true_joint_range(int joint) const;    /* largest minus smallest value so far */
    std::optional<Vec2> finger_position() const; /* nullopt while it is lifted */

private:
    struct Impl;
    explicit World(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

constexpr double finger_radius_m = 0.01;

} // namespace grrl_sim

#endif
