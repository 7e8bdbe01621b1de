/*
 * motion.hpp: the push from which the believed model promises the most relative motion.
 *
 * A quasi-static estimate: while the finger moves body B by its travel along d, the rest of the
 * object stays where the table holds it. Then a believed revolute joint of B with its pivot at q
 * moves by |sin(c - q, d)| of the travel (c: B's centroid), a prismatic one by |cos(axis, d)|, each
 * weighed with the probability of its type. Joints not known yet lie somewhere along B, as many as
 * the shortest body fits into it, with either type as likely: |sin(axis of B, d)| and
 * |cos(axis of B, d)|, half of each. The sum over known and unknown joints counts; no push is
 * repeated while the believed structure stays the same.
 */
#ifndef GRRL_EXPERIMENT_MOTION_HPP
#define GRRL_EXPERIMENT_MOTION_HPP

#include <memory>

#include "chooser.hpp"

namespace grrl_experiment
{

std::unique_ptr<Chooser> make_motion();

/* The estimate for one push of a model's body, in travels of the finger. */
double expected_motion(const grrl_model &model, int body, uint8_t direction);

} // namespace grrl_experiment

#endif
