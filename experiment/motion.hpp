/*
 * motion.hpp: the push from which the believed model promises the most motion in joints it is not
 * sure of.
 *
 * A quasi-static estimate. The finger's contact hardly rubs, so that it transmits the part of its
 * travel along the normal of the side it meets: along the body's axis for a push from behind, else
 * across; that is |cos| or |sin| of the angle between push and axis. While it moves body B that far
 * along n, the rest of the object stays where the table holds it. Then a believed revolute joint of
 * B with its pivot at q moves by |sin(c - q, n)| of it (c: B's centroid), a prismatic one by
 * |cos(its axis, n)|, each weighed with how unsure its type is. Joints not known yet lie somewhere
 * along B, as many as the shortest body fits into it, and move by half of it, as either type is as
 * likely. The sum counts; no push is repeated while the believed structure stays the same.
 *
 * With joints already believed counted in full it moves what it knows, again and again: 28 pushes
 * on RPRPRPR instead of 13.
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
