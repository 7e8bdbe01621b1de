/*
 * object_stream.hpp: a distribution of objects, from which each trial of a life draws one.
 *
 * A file has one statement a line, in any order; # starts a comment:
 *   links 3..6        links of an object, 2 to 10
 *   revolute 0, 0.5, 1  share of revolute joints in an object; the others are prismatic
 *   branches 0.3      share of links that hang on any link instead of on the last one
 *   loops 0.1         share of objects with a loop of four or five links, if they have four
 *   objects 1, 1, 2   objects on the table
 *   size 0.6..1.2     factor of all lengths of an object
 *   length 0.8..1.25  factor of a link's length
 *   width 0.9..1.1    factor of a link's width
 *   friction 0.7..1.4 factor of a joint's friction
 * A value is a number or a range; of several, each is equally likely. What a file does not say is
 * links 3..6, revolute 0.5, no branches, no loops, one object, and the default dimensions. Joint
 * friction follows the size of the links (ObjectScale::similar).
 */
#ifndef GRRL_SIM_OBJECT_STREAM_HPP
#define GRRL_SIM_OBJECT_STREAM_HPP

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "object.hpp"
#include "random.hpp"

namespace grrl_sim
{

class ObjectStream
{
public:
    /* The same seed gives the same object; trial_seed makes one from a run's seed and a trial. */
    ObjectSpec sample(uint64_t seed, const ObjectScale &scale = {}) const;

    enum Setting {
        LINKS,
        OBJECTS,
        REVOLUTE,
        BRANCHES,
        LOOPS,
        SIZE,
        LENGTH,
        WIDTH,
        FRICTION,
        SETTINGS
    };
    struct Range {
        double low;
        double high;
    };
    using Ranges = std::vector<Range>;

    ObjectStream();
    void set(Setting setting, Ranges ranges) { ranges_[setting] = std::move(ranges); }
    const Ranges &ranges(Setting setting) const { return ranges_[setting]; }

private:
    double draw(Setting setting, Random &random) const;
    int draw_whole(Setting setting, Random &random) const;
    void add_object(ObjectSpec &object, bool loops, Random &random) const;

    std::array<Ranges, SETTINGS> ranges_;
};

/* Errors start with path:line:column. The second reads from a text instead. */
Result<ObjectStream> stream_from_file(const std::string &path);
Result<ObjectStream> stream_from_text(const std::string &text, const std::string &path);

/* The structure of an object as a term, such as R(l1, P(l2, l3)). */
std::string term_of(const ObjectSpec &object);

} // namespace grrl_sim

#endif
