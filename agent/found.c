/* Prints terms and joints. */
#include "found.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

void grrl_found_take(struct grrl_found *found, const struct grrl_agent *agent,
                     const struct grrl_agent_event *event)
{
    static struct grrl_term_node nodes[GRRL_FOUND_NODES];
    static struct grrl_term_store store;
    grrl_term term;
    uint8_t a, b;
    grrl_term_store_init(&store, nodes, GRRL_FOUND_NODES);
    found->known = grrl_learner_term(&agent->learner, &store, &term) == GRRL_OK &&
                   grrl_term_print(&store, term, sizeof found->term, found->term, NULL) == GRRL_OK;
    found->trial_id = event->trial_id;
    found->pushes = event->pushes;
    found->model = *grrl_perception_model(&agent->learner.perception);
    found->sure = grrl_agent_sureness(agent, &a, &b);
    found->pair[0] = found->model.body[a].number;
    found->pair[1] = found->model.body[b].number;
}

void grrl_found_print_line(const struct grrl_found *found)
{
    if (!found->known)
        return;
    (void)printf("trial %" PRId32 " after push %" PRId32 ": %s", found->trial_id, found->pushes,
                 found->term);
    if (found->model.n_bodies >= 2 && found->sure > 0.0f)
        (void)printf("; least sure of f%u f%u, %.3f", found->pair[0], found->pair[1],
                     (double)found->sure);
    else if (found->model.n_bodies >= 2)
        (void)printf("; f%u f%u undetermined", found->pair[0], found->pair[1]);
    (void)putchar('\n');
}

static void print_joint(const struct grrl_model *model, const struct grrl_joint *joint)
{
    const double degree = 180.0 / (double)GRRL_PI;
    bool slides = joint->type == GRRL_PRISMATIC;
    (void)printf("  f%u f%u %s %.3f, %s (%.4f, %.4f) m", (unsigned)model->body[joint->a].number,
                 (unsigned)model->body[joint->b].number, slides ? "prismatic" : "revolute",
                 (double)joint->probability, slides ? "through" : "pivot", (double)joint->point_m.x,
                 (double)joint->point_m.y);
    if (slides)
        (void)printf(" along %.1f degrees, seen from %.4f to %.4f m\n",
                     (double)grrl_atan2(joint->axis.y, joint->axis.x) * degree,
                     (double)joint->lower, (double)joint->upper);
    else
        (void)printf(", seen from %.1f to %.1f degrees\n", (double)joint->lower * degree,
                     (double)joint->upper * degree);
}

void grrl_found_print(const struct grrl_found *found)
{
    if (!found->known)
        return;
    (void)printf("found after push %" PRId32 ": %s\n", found->pushes, found->term);
    for (unsigned i = 0; i < found->model.n_joints; i++)
        print_joint(&found->model, &found->model.joint[i]);
}
