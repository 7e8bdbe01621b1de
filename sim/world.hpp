/*
 * world.hpp: the table with the object, the finger that pushes it and the camera above.
 *
 * Planar, seen from above, with dry friction everywhere (Box2D). No two pushes come out alike:
 * contact and direction are off a little and every friction changes from push to push; but the
 * same seed and the same commands give the same run bit for bit.
 *
 * Order of calls: the constructor, then begin_push, then step_frame until it returns false, with
 * observe whenever a frame is wanted.
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
    Vec2 table_m{2.0, 1.6};      /* centred on the origin; holds a chain of 8 links of 0.13 m */
    double table_friction = 0.4; /* Coulomb, between the table and every link */
    double contact_offset_sigma_m = 0.005;
    double push_direction_sigma_rad = radians(5.0);
    double friction_spread = 0.2; /* each friction is off by up to this share in each push */
    TrackerParams tracker;
};

/* Empty if the parameters make a world, else which does not and what would be right. */
std::string check_world(const WorldParams &params);

class World
{
public:
    /* A random configuration of the object at a random place; parameters that check_world passes.
     */
    World(const ObjectSpec &object, const WorldParams &params, uint64_t seed);
    ~World();
    World(World &&) noexcept;

    /* The scene as it lies now, at rest; its pushes and pictures are off by the noise of another
     * seed. For trying out what a push would do: this world does not change. */
    World copy(uint64_t seed) const;

    World &operator=(World &&) noexcept;

    /* Starts a push. Returns why not (check_push, or one is going on), or an empty text. */
    std::string begin_push(const PushCommand &command);

    /* Advances 1/30 s. Whether a push is still going on or the object has not come to rest yet. */
    bool step_frame();

    /* Of the last push that is over. */
    const PushResult &push_result() const;

    /* What the camera sees now; fresh noise in every call. */
    void observe(Frame &frame);

    double time_s() const;

    /* Of every position and velocity, bit for bit: equal runs have equal hashes. */
    uint64_t state_hash() const;

    /* The truth, for the supervisor, for tests and for pictures; no part of a frame. */
    const ObjectSpec &object() const;
    const Tracker &tracker() const;
    std::vector<Pose> true_poses() const;
    double true_joint_value(int joint) const;
    double true_loop_gap_m(int joint) const;     /* between the anchors that should coincide */
    double true_joint_range(int joint) const;    /* the greatest minus the least value so far */
    std::optional<Vec2> finger_position() const; /* nothing while it is lifted */

private:
    struct Impl;
    explicit World(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

constexpr double finger_radius_m = 0.01;

} // namespace grrl_sim

#endif
