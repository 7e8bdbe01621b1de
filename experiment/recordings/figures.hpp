/* figures.hpp: shares of recordings and of joints. */
#ifndef GRRL_EXPERIMENT_RECORDINGS_FIGURES_HPP
#define GRRL_EXPERIMENT_RECORDINGS_FIGURES_HPP

#include <string>
#include <vector>

#include "study.hpp"

namespace grrl_experiment::recordings
{

/* Joints by their probability. */
struct Bin {
    const char *name;
    double low;
    double high;
};
enum { SURE = 2, BINS = 3 };
extern const Bin bins[BINS];

struct Interval {
    double low;
    double high;
};

struct Share {
    int part = 0;
    int of = 0;
    Share &operator+=(const Share &other);
    double percent() const;    /* below 0: no data */
    Interval interval() const; /* Wilson's 95%, in percent */
};

struct Figures {
    int recordings = 0;
    Share failed; /* no answer */
    Share right;  /* mechanisms with the right structure */
    Share fixed;  /* the same, in front of a camera at rest */
    Share mechanism_false;
    Share missed;             /* of all true joints */
    Share independent_right;  /* bodies right and no joint */
    Share independent_called; /* recordings with a joint of at least .5 ... */
    Share independent_sure;   /* ... and of at least .95 */
    Share hand;               /* right structure */
    Share bodies;             /* recordings with all bodies right */
    Share calibration[BINS];
    double error = 0.0; /* sums */
    double ms = 0.0;
};

/* Empty: all conditions, all objects. */
Figures figures(const std::vector<Result> &results, Method method, const std::string &conditions,
                const std::string &object);

/* In the order of the grid. */
std::vector<std::string> conditions_of(const std::vector<Result> &results);

} // namespace grrl_experiment::recordings

#endif
