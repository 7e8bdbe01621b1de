/* report_text.c: the answer for people. */
#include "report.h"

static unsigned count_features(const struct grrl_model *model, unsigned body)
{
    unsigned n = 0;
    for (unsigned i = 0; i < model->n_features; i++)
        n += model->feature_body[i] == body;
    return n;
}

static void print_bodies(FILE *file, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    (void)fprintf(file, "\nbodies %u\n", (unsigned)model->n_bodies);
    for (unsigned i = 0; i < model->n_bodies; i++) {
        const struct grrl_body *body = &model->body[i];
        (void)fprintf(file, "  f%-3u %3u features, %.4g x %.4g %s at (%.4g, %.4g)\n",
                      (unsigned)body->number, (unsigned)body->n_features,
                      (double)body->length_m * report->per_metre,
                      (double)body->width_m * report->per_metre, report->unit,
                      (double)body->centroid_m.x * report->per_metre,
                      (double)body->centroid_m.y * report->per_metre);
    }
    (void)fprintf(file, "  background %u features, unassigned %u\n",
                  count_features(model, GRRL_FEATURE_BACKGROUND),
                  count_features(model, GRRL_FEATURE_NONE));
}

double grrl_report_dropped_percent(const struct grrl_report *report)
{
    const struct grrl_perception_counts *counts = report->counts;
    const struct grrl_tracks *tracks = report->recording;
    const struct grrl_tracks_lost *lost = &tracks->lost;
    size_t gone = tracks->left_out.n_points + lost->marked + lost->frozen + lost->beyond;
    size_t all = tracks->n_points + gone;
    double dropped = (double)gone + (double)counts->outliers + (double)counts->refused +
                     (double)counts->overflow;
    return all > 0 ? 100.0 * dropped / (double)all : 0.0;
}

static double square_root(double x)
{
    return (double)grrl_sqrt((float)(x > 0.0 ? x : 0.0));
}

static void print_joint(FILE *file, const struct grrl_report *report,
                        const struct grrl_joint *joint)
{
    const struct grrl_model *model = report->model;
    const double scale = report->per_metre;
    const double degree = 180.0 / (double)GRRL_PI;
    bool slides = joint->type == GRRL_PRISMATIC;
    double to_unit = slides ? scale : degree;
    (void)fprintf(file, "  f%u f%u %s %.3f (revolute %.3f, prismatic %.3f, disconnected %.3f)\n",
                  (unsigned)model->body[joint->a].number, (unsigned)model->body[joint->b].number,
                  slides ? "prismatic" : "revolute", (double)joint->probability,
                  (double)joint->p_revolute, (double)joint->p_prismatic,
                  (double)joint->p_disconnected);
    (void)fprintf(file, "      %s (%.4g, %.4g)", slides ? "through" : "pivot",
                  (double)joint->point_m.x * scale, (double)joint->point_m.y * scale);
    if (slides)
        (void)fprintf(file, " along %.1f +- %.1f degrees",
                      (double)grrl_atan2(joint->axis.y, joint->axis.x) * degree,
                      (double)joint->axis_sd_rad * degree);
    else
        (void)fprintf(file, " +- (%.2g, %.2g) %s",
                      square_root((double)joint->point_cov_m2[0]) * scale,
                      square_root((double)joint->point_cov_m2[2]) * scale, report->unit);
    (void)fprintf(file, ", seen from %.3g to %.3g %s\n", (double)joint->lower * to_unit,
                  (double)joint->upper * to_unit, slides ? report->unit : "degrees");
}

const char *grrl_report_relation(const struct grrl_report *report, unsigned a, unsigned b,
                                 struct grrl_pair *pair)
{
    const float third = 1.0f / 3.0f;
    if (grrl_report_is_solid(report, a) || grrl_report_is_solid(report, b) ||
        grrl_perception_pair(report->perception, grrl_report_origin(report, a),
                             grrl_report_origin(report, b), pair) != GRRL_OK)
        *pair = (struct grrl_pair){.relation = GRRL_RELATION_UNDETERMINED,
                                   .reason = GRRL_REASON_SIZES,
                                   .p_revolute = third,
                                   .p_prismatic = third,
                                   .p_disconnected = third};
    return pair->relation == GRRL_RELATION_JOINED         ? "joined"
           : pair->relation == GRRL_RELATION_DISCONNECTED ? "disconnected"
                                                          : "undetermined";
}

/* How far two bodies moved apart, and what tells a joint. */
static struct grrl_reason_text too_little(const struct grrl_report *report,
                                          const struct grrl_pair *pair)
{
    const struct grrl_perception_config *config = &report->perception->config;
    const double degree = 180.0 / (double)GRRL_PI;
    bool noisy = pair->turned_rad > config->min_turn_rad || pair->slid_m > config->min_slide_m;
    struct grrl_reason_text reason;
    (void)snprintf(reason.text, sizeof reason.text,
                   "%s: turned %.2g of the %.2g degrees, slid %.2g of the %.2g %s needed",
                   noisy ? "no more relative motion than noise" : "too little relative motion",
                   (double)pair->turned_rad * degree, (double)config->min_turn_rad * degree,
                   (double)pair->slid_m * report->per_metre,
                   (double)config->min_slide_m * report->per_metre, report->unit);
    return reason;
}

struct grrl_reason_text grrl_report_reason(const struct grrl_report *report,
                                           const struct grrl_pair *pair)
{
    static const char *const words[] = {
        [GRRL_REASON_NONE] = "",
        [GRRL_REASON_NO_TYPE] = "neither type explains the motion, or both do",
        [GRRL_REASON_UNPROVEN] = "independent motion explains it as well",
        [GRRL_REASON_FAR] = "too far from the joint the motion suggests",
        [GRRL_REASON_SIZES] = "they do not move in one plane",
        [GRRL_REASON_STRUCTURE] = "other joints leave no room for this one",
    };
    struct grrl_reason_text reason = {""};
    if (pair->reason == GRRL_REASON_LITTLE)
        return too_little(report, pair);
    bool slid = pair->p_prismatic > pair->p_revolute;
    const char *text = pair->reason >= sizeof words / sizeof words[0] ? "" : words[pair->reason];
    if (pair->reason == GRRL_REASON_UNPROVEN && slid)
        text = "slid once, which independent motion explains as well; sliding back or turning "
               "together would tell";
    (void)snprintf(reason.text, sizeof reason.text, "%s", text);
    return reason;
}

static void print_other_pairs(FILE *file, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    const char *heading = "\nother pairs\n";
    for (unsigned a = 0; a < model->n_bodies; a++) {
        for (unsigned b = a + 1; b < model->n_bodies; b++) {
            struct grrl_pair pair;
            const char *relation = grrl_report_relation(report, a, b, &pair);
            if (pair.relation == GRRL_RELATION_JOINED)
                continue;
            (void)fprintf(file,
                          "%s  f%u f%u %s (revolute %.3f, prismatic %.3f, disconnected %.3f)%s%s\n",
                          heading, (unsigned)model->body[a].number, (unsigned)model->body[b].number,
                          relation, (double)pair.p_revolute, (double)pair.p_prismatic,
                          (double)pair.p_disconnected, pair.reason == GRRL_REASON_NONE ? "" : ": ",
                          grrl_report_reason(report, &pair).text);
            heading = "";
        }
    }
}

void grrl_report_text(FILE *file, const struct grrl_report *report)
{
    const struct grrl_model *model = report->model;
    (void)fprintf(file, "%s\n", report->term);
    print_bodies(file, report);
    (void)fprintf(file, "\njoints %u\n", (unsigned)model->n_joints);
    for (unsigned i = 0; i < model->n_joints; i++)
        print_joint(file, report, &model->joint[i]);
    print_other_pairs(file, report);
    (void)fprintf(file, "\n%u frames of %u tracks, %u keyframe%s, profile %s, noise %.3g %s\n",
                  report->frames, report->tracks, report->keyframes,
                  report->keyframes == 1 ? "" : "s", report->profile, report->noise, report->unit);
    (void)fprintf(
        file, "points dropped: %u outliers, %u refused, %zu beyond capacity, %zu lost (%.1f%%)\n",
        (unsigned)report->counts->outliers, (unsigned)report->counts->refused,
        report->recording->left_out.n_points + report->counts->overflow,
        report->recording->lost.marked + report->recording->lost.frozen +
            report->recording->lost.beyond,
        grrl_report_dropped_percent(report));
}
