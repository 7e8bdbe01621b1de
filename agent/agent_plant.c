/*
 * agent_plant.c: detects mistakes of trackers and robots.
 *
 * The protocol does not notice a wrong unit, a message on the wrong channel or a phase that never
 * changes: nothing happens, or the wrong thing. So the agent looks for common mistakes, reports
 * each kind once, with a remedy, and then counts.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agent_internal.h"
#include "grrl/base/settling.h"

/* PATIENCE_US: how long something may look wrong. A frame is strange if fewer than a quarter of its
 * points are where the previous frame had a point with that id; STRANGE_FRAMES in a row are no
 * accident. */
enum {
    PATIENCE_US = 2000000,
    OVERTIME_US = 5000000,
    LEAST_HZ = 10,
    STRANGE_FRAMES = 10,
    STRANGE_SAMPLE = 64,
    FEW = 4
};
#define NEAR_M 0.05f

/* Above this extent the unit may be millimetres; a sixteenth of the points at each end may be
 * outliers. */
#define SPAN_M 2.0f

static const char *const texts[GRRL_AGENT_MISTAKES] = {
    "push commands sent again after 2 s without acknowledgement",
    "frames ignored because they belong to no trial",
    "frames with ids unlike those of the previous frame",
    "frames refused because their points span metres",
    "points refused because they are off the table",
    "pushes not sent because they would leave the table",
    "periods of 2 s with fewer than 20 frames",
    "frames at REST after 2 s of REST",
    "frames of a push 5 s or more after its timeout",
};

const char *grrl_agent_mistake_text(enum grrl_agent_mistake mistake)
{
    return texts[mistake];
}

int64_t grrl_agent_mistakes(const struct grrl_agent *agent, enum grrl_agent_mistake mistake)
{
    return agent->plant.mistakes[mistake];
}

bool agent_mistake(struct grrl_agent *agent, enum grrl_agent_mistake mistake, int64_t n)
{
    bool first = agent->plant.mistakes[mistake] == 0;
    agent->plant.mistakes[mistake] += n;
    return first;
}

/* --- frames ----------------------------------------------------------------------------------- */

/* 10 Hz over 2 s. In lock-step the agent sets the pace. */
static void watch_rate(struct grrl_agent *agent, const grrl_points_t *points, int64_t now)
{
    struct grrl_agent_plant *plant = &agent->plant;
    if (points->mode != GRRL_POINTS_T_REAL_TIME || plant->window_us == 0) {
        plant->window_us = now;
        plant->window_n = 0;
        return;
    }
    plant->window_n++;
    if (now - plant->window_us < PATIENCE_US)
        return;
    double hz = plant->window_n * 1e6 / (double)(now - plant->window_us);
    plant->window_us = now;
    plant->window_n = 0;
    if (hz < LEAST_HZ && agent_mistake(agent, GRRL_MISTAKE_SLOW, 1)) {
        (void)snprintf(
            agent->note, sizeof agent->note,
            "the tracker sends %.1f frames per second; it needs %d to 100: between two frames a "
            "pushed point must move less than 15 mm; track faster, or push slower with --speed",
            hz, LEAST_HZ);
        agent_note(agent, agent->note);
    }
}

/* Whether the previous frame had this point near its present position. Ids mostly keep their order,
 * so the search starts after the last one found. */
static bool was_there(const struct grrl_agent_plant *plant, int32_t id, float x, float y,
                      int32_t *at)
{
    for (int32_t i = 0; i < plant->n_points; i++) {
        int32_t k = (*at + 1 + i) % plant->n_points;
        if (plant->id[k] != id)
            continue;
        *at = k;
        float dx = plant->x[k] - x;
        float dy = plant->y[k] - y;
        return dx * dx + dy * dy < NEAR_M * NEAR_M;
    }
    return false;
}

static void watch_ids(struct grrl_agent *agent, const grrl_points_t *points)
{
    struct grrl_agent_plant *plant = &agent->plant;
    int32_t n = points->n_points < STRANGE_SAMPLE ? points->n_points : STRANGE_SAMPLE;
    int32_t kept = 0;
    int32_t at = -1;
    for (int32_t i = 0; i < n && 4 * kept < n; i++)
        kept += was_there(plant, points->id[i], points->x[i], points->y[i], &at);
    bool strange = n >= FEW && plant->n_points >= FEW && 4 * kept < n;
    plant->strange_n = strange ? plant->strange_n + 1 : 0;
    plant->n_points = points->n_points;
    memcpy(plant->id, points->id, (size_t)points->n_points * sizeof plant->id[0]);
    memcpy(plant->x, points->x, (size_t)points->n_points * sizeof plant->x[0]);
    memcpy(plant->y, points->y, (size_t)points->n_points * sizeof plant->y[0]);
    if (plant->strange_n >= STRANGE_FRAMES && agent_mistake(agent, GRRL_MISTAKE_IDS, 1))
        agent_note(
            agent,
            "the ids change from frame to frame: a feature must keep its id as long "
            "as it is tracked; an id is not an index in a list and never goes to another feature");
}

static void tell_no_trial(struct grrl_agent *agent, const grrl_points_t *points)
{
    const grrl_trial_t *trial = &agent->trial;
    if (trial->revision == 0)
        (void)snprintf(agent->note, sizeof agent->note,
                       "frames are ignored: they name trial %" PRId32 ", but no GRRL_TRIAL has "
                       "offered it; without a supervisor send trial_id 0",
                       points->trial_id);
    else if (points->trial_id == 0)
        (void)snprintf(agent->note, sizeof agent->note,
                       "frames are ignored: their trial_id is 0, but GRRL_TRIAL announces trial "
                       "%" PRId32 "; send that, or no GRRL_TRIAL",
                       trial->trial_id);
    else
        (void)snprintf(agent->note, sizeof agent->note,
                       "frames are ignored: they name trial %" PRId32 ", and the newest "
                       "GRRL_TRIAL does not offer it (trial %" PRId32 ", judged_cmd_seq %" PRId32
                       "); a trial is offered with RUNNING and judged_cmd_seq -1 before its frames",
                       points->trial_id, trial->trial_id, trial->judged_cmd_seq);
    agent_note(agent, agent->note);
}

static void watch_trial(struct grrl_agent *agent, const grrl_points_t *points, bool taken,
                        int64_t now)
{
    struct grrl_agent_plant *plant = &agent->plant;
    if (taken) {
        plant->ignored_us = 0;
        return;
    }
    if (plant->ignored_us == 0)
        plant->ignored_us = now;
    if (now - plant->ignored_us >= PATIENCE_US && agent_mistake(agent, GRRL_MISTAKE_NO_TRIAL, 1))
        tell_no_trial(agent, points);
}

static void watch_rest(struct grrl_agent *agent, const grrl_points_t *points, int64_t now)
{
    struct grrl_agent_plant *plant = &agent->plant;
    if (points->phase != GRRL_POINTS_T_REST || agent->phase != PHASE_WATCHING) {
        plant->rest_us = 0;
        return;
    }
    if (plant->rest_us == 0) {
        plant->rest_us = now;
        plant->rest_n = 0;
    }
    plant->rest_n++;
    if (now - plant->rest_us >= PATIENCE_US && plant->rest_n > GRRL_SETTLING_FRAMES &&
        agent_mistake(agent, GRRL_MISTAKE_REST, 1)) {
        (void)snprintf(agent->note, sizeof agent->note,
                       "the phase has been REST for 2 s: after %d frames at rest send SETTLED, "
                       "which the agent waits for; or always send UNKNOWN, and it counts by itself",
                       GRRL_SETTLING_FRAMES);
        agent_note(agent, agent->note);
    }
}

/* Detects a push that does not end. The robot must keep to the time; afterwards the object may
 * slide. */
static void watch_moving(struct grrl_agent *agent, const grrl_points_t *points, int64_t now)
{
    bool by_status =
        points->phase == GRRL_POINTS_T_UNKNOWN && agent->status.state == GRRL_PUSH_STATUS_T_MOVING;
    bool moving = points->phase == GRRL_POINTS_T_PUSHING || by_status;
    int64_t allowed_us = (int64_t)((double)agent->command.timeout * 1e6) + OVERTIME_US;
    if (moving && agent->phase == PHASE_WATCHING && agent->cmd_seq > 0 &&
        now - agent->plant.commanded_us >= allowed_us &&
        agent_mistake(agent, GRRL_MISTAKE_MOVING, 1)) {
        (void)snprintf(agent->note, sizeof agent->note,
                       "push %" PRId32 " is not finished 5 s after its timeout of %.1f s: %s once "
                       "the tool is lifted and the object is at rest",
                       agent->cmd_seq, (double)agent->command.timeout,
                       by_status ? "the robot must report DONE"
                                 : "the phase must become REST, then SETTLED,");
        agent_note(agent, agent->note);
    }
}

void agent_watch_frame(struct grrl_agent *agent, const grrl_points_t *points, bool taken)
{
    if (agent->config.observe)
        return;
    int64_t now = agent_now_us(agent);
    watch_trial(agent, points, taken, now);
    if (points->seq <= agent->plant.seq)
        return;
    agent->plant.seq = points->seq;
    watch_rate(agent, points, now);
    watch_rest(agent, points, now);
    watch_moving(agent, points, now);
    watch_ids(agent, points);
}

/* --- points ----------------------------------------------------------------------------------- */

/* The extent of the numbers without a sixteenth of them at each end; sorts them. */
static float extent(float *values, int32_t n)
{
    for (int32_t i = 1; i < n; i++) {
        float value = values[i];
        int32_t k = i;
        for (; k > 0 && values[k - 1] > value; k--)
            values[k] = values[k - 1];
        values[k] = value;
    }
    return values[n - 1 - n / 16] - values[n / 16];
}

/* Of at least FEW numbers, in four lanes, which become vectors. */
static float range(const float *values, int32_t n)
{
    float low[4] = {values[0], values[0], values[0], values[0]};
    float high[4] = {values[0], values[0], values[0], values[0]};
    for (int32_t i = 0; i < n; i += 4) {
        const float *four = i + 4 <= n ? values + i : values + n - 4;
        for (int j = 0; j < 4; j++) {
            low[j] = four[j] < low[j] ? four[j] : low[j];
            high[j] = four[j] > high[j] ? four[j] : high[j];
        }
    }
    for (int j = 1; j < 4; j++) {
        low[0] = low[j] < low[0] ? low[j] : low[0];
        high[0] = high[j] > high[0] ? high[j] : high[0];
    }
    return high[0] - low[0];
}

/* Sorts only if the frame looks wrong. */
static float span_of(const float *values, int32_t n)
{
    float sorted[GRRL_WIRE_MAX_POINTS];
    if (n < FEW || range(values, n) <= SPAN_M)
        return 0.0f;
    memcpy(sorted, values, (size_t)n * sizeof sorted[0]);
    return extent(sorted, n);
}

static bool spans_metres(struct grrl_agent *agent, const grrl_points_t *points)
{
    float x = span_of(points->x, points->n_points);
    float y = span_of(points->y, points->n_points);
    float span = x > y ? x : y;
    if (!(span > SPAN_M))
        return false;
    if (agent_mistake(agent, GRRL_MISTAKE_SPAN, 1)) {
        (void)snprintf(agent->note, sizeof agent->note,
                       "the points span %.4g m and are refused: are they millimetres? x and y are "
                       "metres; if the table is that large, specify it with --table X0,Y0,X1,Y1",
                       (double)span);
        agent_note(agent, agent->note);
    }
    return true;
}

static void drop_off_table(struct grrl_agent *agent, grrl_points_t *points)
{
    const struct grrl_agent_table *table = &agent->config.table;
    int32_t all = points->n_points;
    int32_t n = 0;
    for (int32_t i = 0; i < all; i++) {
        float x = points->x[i];
        float y = points->y[i];
        if (!(x >= table->x0_m && x <= table->x1_m && y >= table->y0_m && y <= table->y1_m))
            continue;
        points->id[n] = points->id[i];
        points->x[n] = x;
        points->y[n] = y;
        n++;
    }
    points->n_points = n;
    if (n < all && agent_mistake(agent, GRRL_MISTAKE_OFF_TABLE, all - n)) {
        (void)snprintf(agent->note, sizeof agent->note,
                       "%" PRId32 " of %" PRId32 " points lie outside --table and are refused%s",
                       all - n, all, n == 0 ? ": are both in metres, and in the same frame?" : "");
        agent_note(agent, agent->note);
    }
}

bool agent_admit_frame(struct grrl_agent *agent, grrl_points_t *points)
{
    if (agent->config.observe)
        return true;
    if (!agent_has_table(agent))
        return !spans_metres(agent, points);
    drop_off_table(agent, points);
    return true;
}

/* --- the robot -------------------------------------------------------------------------------- */

void agent_watch_status(struct grrl_agent *agent, const grrl_push_status_t *status)
{
    bool ours = status->agent_session_id == agent->config.session_id &&
                status->trial_id == agent->trial_id && status->cmd_seq == agent->cmd_seq;
    if (!agent->config.observe && !ours && status->state != GRRL_PUSH_STATUS_T_IDLE)
        agent->plant.other = *status;
}

static void tell_unacknowledged(struct grrl_agent *agent)
{
    const grrl_push_status_t *other = &agent->plant.other;
    const grrl_push_status_t *own = &agent->status;
    int n = snprintf(agent->note, sizeof agent->note,
                     "nothing acknowledges push %" PRId32 " after 2 s: ", agent->cmd_seq);
    char *to = agent->note + n;
    size_t left = sizeof agent->note - (size_t)n;
    if (own->session_id != 0 && own->cmd_seq == agent->cmd_seq)
        (void)snprintf(to, left,
                       "the robot does, but not the frames, whose phase is known; ack_cmd_seq must "
                       "become the cmd_seq of the push, or the phase must always be UNKNOWN");
    else if (other->session_id != 0)
        (void)snprintf(to, left,
                       "GRRL_PUSH_STATUS came for agent_session_id %" PRId64 ", trial_id %" PRId32
                       ", cmd_seq %" PRId32 "; copy all three from the command: %" PRId64
                       ", %" PRId32 ", %" PRId32,
                       other->agent_session_id, other->trial_id, other->cmd_seq,
                       agent->config.session_id, agent->trial_id, agent->cmd_seq);
    else
        (void)snprintf(to, left,
                       "the robot must subscribe to GRRL_PUSH_COMMAND, obey commands with its "
                       "plant_session_id, and answer MOVING on GRRL_PUSH_STATUS");
    agent_note(agent, agent->note);
}

void agent_forget_plant(struct grrl_agent *agent)
{
    struct grrl_agent_plant *plant = &agent->plant;
    plant->seq = 0;
    plant->window_us = 0;
    plant->ignored_us = 0;
    plant->rest_us = 0;
    plant->strange_n = 0;
    plant->n_points = 0;
    plant->other.session_id = 0;
}

void agent_watch_resend(struct grrl_agent *agent)
{
    if (agent_now_us(agent) - agent->plant.commanded_us >= PATIENCE_US &&
        agent_mistake(agent, GRRL_MISTAKE_UNACKNOWLEDGED, 1))
        tell_unacknowledged(agent);
}
