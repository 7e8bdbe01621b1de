/*
 * motion.hpp: chooses the push for which the estimated model predicts the most motion in joints of
 * uncertain type.
 *
 * The prediction is quasi-static. The finger's contact has little friction, so it transmits the
 * part of its travel along the normal of the side it meets: along the body's axis for a push from
 * behind, else perpendicular to it. That part is |cos| or |sin| of the angle between push and axis.
 * While the finger moves body B that far along n, the table holds the rest of the object in place.
 * Then an estimated revolute joint of B with its pivot at q moves by |sin(c - q, n)| of that
 * distance (c: B's centroid), and a prismatic one by |cos(its axis, n)|. Each is weighted by the
 * uncertainty of its type. Joints not yet known lie somewhere along B; their number is how often
 * the shortest body fits into it, and each moves by half of it, as either type is equally likely.
 * The prediction is the sum. No push is repeated while the estimated structure stays the same.
 *
 * If known joints counted in full, it would move the same joints again and again: 19 pushes on
 * RPRPRPR instead of 13 (60 trials each).
 */
#ifndef GRRL_EXPERIMENT_MOTION_HPP
#define GRRL_EXPERIMENT_MOTION_HPP

#include <memory>

#include "chooser.hpp"

namespace grrl_experiment
{

std::unique_ptr<Chooser> make_motion();

/* The prediction for one push of a model's body, in units of the finger's travel. */
double expected_motion(const grrl_model &model, int body, uint8_t direction);

} // namespace grrl_experiment

#endif
