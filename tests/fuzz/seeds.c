/*
 * fuzz_seeds FOLDER: writes valid inputs for every fuzz target, FOLDER/fuzz_<name>/<seed>, made by
 * our own encoders, so that they stay valid when a format changes.
 */
#define _POSIX_C_SOURCE 200809L

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "controller.h"
#include "grrl/base/settling.h"
#include "grrl/learner/learner.h"
#include "link.h"
#include "policy_memory.h"
#include "wire.h"

enum { POINTS = 12, PER_LINK = 6, PATH_BYTES = 1024, TURNS = 12, PUSH_FRAMES = 2 };

static const char *folder;
static struct grrl_wire_points points;
static struct grrl_wire_model model;
static struct grrl_wire_why why;
static struct onboard_packet packet;
static uint8_t bytes[GRRL_WIRE_MAX_BYTES];

static FILE *create(const char *target, const char *name)
{
    char path[PATH_BYTES];
    (void)snprintf(path, sizeof path, "%s/fuzz_%s", folder, target);
    if (mkdir(path, 0777) != 0 && errno != EEXIST) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    (void)snprintf(path, sizeof path, "%s/fuzz_%s/%s", folder, target, name);
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    return file;
}

static void put(FILE *file, const void *data, size_t size)
{
    if (fwrite(data, 1, size, file) != size) {
        perror("fuzz_seeds");
        exit(EXIT_FAILURE);
    }
}

static void write_text(const char *target, const char *name, const char *text)
{
    FILE *file = create(target, name);
    put(file, text, strlen(text));
    (void)fclose(file);
}

/* Two links with a hinge between them, the second turned away. */
static void place(float turn)
{
    for (int i = 0; i < POINTS; i++) {
        float along = 0.13f * ((float)(i % PER_LINK) + 0.5f) / (float)PER_LINK;
        float across = 0.008f * (float)(i * 7 % 5 - 2);
        float angle = i < PER_LINK ? 3.1416f : turn;
        points.id[i] = i;
        points.x[i] = along * cosf(angle) - across * sinf(angle);
        points.y[i] = along * sinf(angle) + across * cosf(angle);
    }
    points.message.n_points = POINTS;
}

/* --- messages --------------------------------------------------------------------------------- */

static void write_message(uint8_t type, const char *name, int size)
{
    if (size < 0) {
        (void)fprintf(stderr, "fuzz_seeds: %s\n", why.text);
        exit(EXIT_FAILURE);
    }
    FILE *file = create("wire", name);
    put(file, &type, 1);
    put(file, bytes, (size_t)size);
    (void)fclose(file);
}

static void fill_model(void)
{
    grrl_model_t *message = &model.message;
    grrl_wire_bind_model(&model);
    message->session_id = 1;
    message->n_links = 2;
    message->n_joints = 1;
    message->n_features = 3;
    for (int i = 0; i < 2; i++) {
        model.link_number[i] = (int16_t)(i + 1);
        model.link_length[i] = 0.13f;
    }
    model.joint_b[0] = 1;
    model.joint_probability[0] = 0.9f;
    model.feature_link[2] = GRRL_MODEL_T_BACKGROUND;
}

static void write_messages(void)
{
    const grrl_push_command_t command = {
        .session_id = 1, .plant_session_id = 2, .points_seq = 3, .cmd_seq = 1, .kind = 1};
    const grrl_push_status_t status = {.session_id = 2, .agent_session_id = 1, .cmd_seq = 1};
    const grrl_trial_t trial = {
        .session_id = 2, .trial_id = 1, .revision = 1, .judged_cmd_seq = -1};
    const grrl_decision_t decision = {
        .session_id = 1, .trial_id = 1, .cmd_seq = 1, .source_index = -1, .phi = 0.5f};
    const grrl_agent_status_t agent_status = {.session_id = 1, .received = 5};
    const grrl_stop_t stop = {.session_id = 2, .reason = GRRL_STOP_T_FAULT};
    enum { ALL = GRRL_WIRE_MAX_BYTES };
    fill_model();
    place(0.3f);
    write_message(0, "points", grrl_wire_encode_points(&points.message, ALL, bytes, &why));
    write_message(1, "model", grrl_wire_encode_model(&model.message, ALL, bytes, &why));
    write_message(2, "command", grrl_wire_encode_push_command(&command, ALL, bytes, &why));
    write_message(3, "status", grrl_wire_encode_push_status(&status, ALL, bytes, &why));
    write_message(4, "trial", grrl_wire_encode_trial(&trial, ALL, bytes, &why));
    write_message(5, "decision", grrl_wire_encode_decision(&decision, ALL, bytes, &why));
    write_message(6, "agent_status",
                  grrl_wire_encode_agent_status(&agent_status, ALL, bytes, &why));
    uint8_t pixels[16 * 16] = {1, 2, 3};
    const grrl_image_t image = {.session_id = 2,
                                .seq = 1,
                                .width = 16,
                                .height = 16,
                                .n_bytes = sizeof pixels,
                                .data = pixels};
    write_message(7, "image", grrl_wire_encode_image(&image, ALL, bytes, &why));
    write_message(8, "stop", grrl_wire_encode_stop(&stop, ALL, bytes, &why));
}

/* --- logs ------------------------------------------------------------------------------------- */

static void log_bytes(lcm_eventlog_t *log, const char *channel, int size)
{
    char name[64];
    (void)snprintf(name, sizeof name, "%s", channel);
    lcm_eventlog_event_t event = {.timestamp = 1,
                                  .channellen = (int32_t)strlen(name),
                                  .datalen = size,
                                  .channel = name,
                                  .data = bytes};
    if (size < 0 || lcm_eventlog_write_event(log, &event) != 0) {
        (void)fprintf(stderr, "fuzz_seeds: cannot write a log: %s\n", why.text);
        exit(EXIT_FAILURE);
    }
}

static void log_frames(lcm_eventlog_t *log, int n, int8_t phase)
{
    for (int i = 0; i < n; i++) {
        points.message.seq++;
        points.message.phase = i == n - 1 ? phase : GRRL_POINTS_T_REST;
        if (phase == GRRL_POINTS_T_PUSHING) {
            place(0.08f * (float)i);
            points.message.phase = phase;
        }
        log_bytes(log, GRRL_CHANNEL_POINTS,
                  grrl_wire_encode_points(&points.message, GRRL_WIRE_MAX_BYTES, bytes, &why));
    }
}

static void log_trial(lcm_eventlog_t *log, int32_t judged, int8_t phase)
{
    static int32_t revision;
    const grrl_trial_t trial = {.session_id = 2,
                                .trial_id = 1,
                                .revision = ++revision,
                                .judged_cmd_seq = judged,
                                .phase = phase,
                                .outcome = phase == GRRL_TRIAL_T_ENDED};
    log_bytes(log, GRRL_CHANNEL_TRIAL,
              grrl_wire_encode_trial(&trial, GRRL_WIRE_MAX_BYTES, bytes, &why));
}

/* A trial of two pushes. */
static void write_log(void)
{
    char path[PATH_BYTES];
    (void)fclose(create("log", "trial"));
    (void)snprintf(path, sizeof path, "%s/fuzz_log/trial", folder);
    lcm_eventlog_t *log = lcm_eventlog_create(path, "w");
    if (log == NULL) {
        perror(path);
        exit(EXIT_FAILURE);
    }
    place(0.0f);
    points.message.seq = 0;
    points.message.trial_id = 1;
    log_trial(log, -1, GRRL_TRIAL_T_RUNNING);
    log_frames(log, GRRL_SETTLING_FRAMES, GRRL_POINTS_T_SETTLED);
    for (int32_t push = 1; push <= PUSH_FRAMES; push++) {
        const grrl_decision_t decision = {
            .session_id = 1, .trial_id = 1, .cmd_seq = push, .link_number = 1, .source_index = -1};
        log_trial(log, push - 1, GRRL_TRIAL_T_RUNNING);
        log_bytes(log, GRRL_CHANNEL_DECISION,
                  grrl_wire_encode_decision(&decision, GRRL_WIRE_MAX_BYTES, bytes, &why));
        points.message.ack_cmd_seq = push;
        log_frames(log, TURNS, GRRL_POINTS_T_PUSHING);
        log_frames(log, 2, GRRL_POINTS_T_SETTLED);
    }
    log_trial(log, PUSH_FRAMES, GRRL_TRIAL_T_ENDED);
    lcm_eventlog_destroy(log);
}

/* --- packets, as they are and on a serial line --------------------------------------------- */

static uint8_t sequence; /* of the last request on the line; 0: the packets are as they are */

static void put_packet(FILE *file)
{
    uint8_t step[2] = {1, sequence}; /* a whole frame, see fuzz_line.c */
    uint8_t head[3] = {packet.type, (uint8_t)packet.n, (uint8_t)(packet.n >> 8)};
    if (sequence > 0) {
        put(file, step, sizeof step);
        sequence = onboard_link_next(sequence);
    }
    put(file, head, sizeof head);
    put(file, packet.bytes, packet.n);
}

static void put_request(FILE *file, enum onboard_packet_type type, unsigned n)
{
    onboard_packet_begin(&packet, (uint8_t)type);
    for (unsigned i = 0; i < n; i++)
        onboard_put(&packet, i == 0, 1);
    put_packet(file);
}

static void put_frame(FILE *file, float turn, bool pushing)
{
    place(turn);
    const struct grrl_frame frame = {POINTS, points.id, points.x, points.y};
    onboard_put_frame(&packet, &frame, pushing);
    put_packet(file);
}

static void write_packets(void)
{
    FILE *file = create(sequence > 0 ? "line" : "packets", "trial");
    put(file, "\1", 1);
    if (sequence > 0)
        put_request(file, ONBOARD_TRIAL, 4);
    put_frame(file, 0.0f, false);
    put_request(file, ONBOARD_PERCEIVE, 0);
    put_request(file, ONBOARD_CHOOSE, 0);
    for (int i = 1; i <= TURNS; i++)
        put_frame(file, 0.08f * (float)i, true);
    put_frame(file, 0.08f * (float)TURNS, false);
    put_request(file, ONBOARD_PERCEIVE, 0);
    put_request(file, ONBOARD_LEARN, 1);
    put_request(file, ONBOARD_EXPECT, 24);
    put_request(file, ONBOARD_CLOSE, 0);
    (void)fclose(file);
}

/* --- experience files ------------------------------------------------------------------------- */

enum { CAPACITY = 24 };

static struct grrl_learner learner;

static int write_out(void *context, const void *data, size_t size)
{
    put(context, data, size);
    return 0;
}

static void watch(float turn, bool pushing)
{
    place(turn);
    const struct grrl_frame frame = {POINTS, points.id, points.x, points.y};
    grrl_learner_observe(&learner, &frame, pushing);
}

static void live_trial(uint32_t trial)
{
    struct grrl_decision decision;
    struct grrl_update update;
    grrl_learner_begin_trial(&learner, trial);
    watch(0.0f, false);
    bool good = grrl_learner_perceive(&learner) == GRRL_OK;
    for (int push = 0; good && push < 4; push++) {
        good = grrl_learner_choose(&learner, &decision) == GRRL_OK;
        for (int i = 1; i <= TURNS; i++)
            watch(0.05f * (float)(push + 1) * (float)i, true);
        watch(0.05f * (float)(push + 1) * (float)TURNS, false);
        good = good && grrl_learner_perceive(&learner) == GRRL_OK &&
               grrl_learner_learn(&learner, push == 3, &update) == GRRL_OK;
    }
    if (!good) {
        (void)fprintf(stderr, "fuzz_seeds: the learner does not learn\n");
        exit(EXIT_FAILURE);
    }
}

static void write_store(const char *name, const struct grrl_policy_type *type, uint8_t flags)
{
    static POLICY_MEMORY(CAPACITY) memory;
    struct grrl_learner_config config;
    struct grrl_policy policy;
    grrl_learner_config_default(&config);
    FILE *file = create("store", name);
    struct grrl_io io = {.context = file, .write = write_out};
    bool good = grrl_policy_make(type, memory.bytes, sizeof memory.bytes, CAPACITY, NULL,
                                 &policy) == GRRL_OK &&
                grrl_learner_init(&learner, &config, policy) == GRRL_OK;
    for (uint32_t trial = 1; good && trial <= 3; trial++)
        live_trial(trial);
    put(file, &flags, 1);
    if (!good || grrl_learner_save(&learner, &io) != GRRL_OK)
        exit(EXIT_FAILURE);
    (void)fclose(file);
}

int main(int argc, char **argv)
{
    if (argc != 2) {
        (void)fprintf(stderr, "usage: %s FOLDER\n", argv[0]);
        return 2;
    }
    folder = argv[1];
    grrl_wire_bind_points(&points);
    points.message.session_id = 2;
    points.message.seq = 1;
    points.message.mode = GRRL_POINTS_T_LOCK_STEP;
    write_messages();
    write_log();
    write_packets();
    sequence = 1;
    write_packets();
    write_store("cases", &grrl_policy_learn, 1);
    write_store("paper", &grrl_policy_paper, 3);
    write_text("csv", "tracks", "frame,point,x,y,visible\n0,1,0.5,-1e-3,1\n1,1,,,0\n1,2,3,4,1\n");
    write_text("csv", "pixels", "point,frame,y_px,x_px,extra\r\n7,-3, 1.5 ,2,z\r\n");
    write_text("csv", "sheet", "Frame;Track ID;X;Y\r\n0;1;2,5;-1\r\n1;1;3,25;4\r\n2;2;nan;NA\r\n");
    write_text(
        "csv", "quoted",
        "\"\",\"t\",\"id\",\"pos_x\",\"pos_y\",\"occluded\"\n\"1\",0.0,1,2.5,1e0,\"FALSE\"\n");
    write_text("csv", "tabs",
               "\xef\xbb\xbf"
               "FRAME\tparticle\tx\ty\r0\t1\t0\t0\r1\t1\t\t\r1\t2\t3\t4\r");
    write_text("csv", "wide", "scorer,a,a\nbodyparts,b,b\ncoords,x,y\n0,1,2\n");
    write_text("csv", "lost",
               "frame,point,x,y\n0,1,5,5\n1,1,5.1,5\n2,1,5.2,5\n3,1,0,0\n4,1,0,0\n5,1,0,0\n"
               "6,1,5.3,5\n0,2,7,5\n1,2,7.1,5\n2,2,7.2,5\n3,2,7.3,5\n4,2,7.4,5\n5,2,7.5,5\n");
    write_text("term", "chain", "D(lb, R(L(s, f1), P(L(l, f2), L(_, f3))))");
    write_text("term", "loop", "R(l1, R(l5, R(l4, R(l3, R(l2, l1))))) & P(v1, L(v2, l9))");
    write_text("term", "names", "D(lb, R(L(s, blade1), P(s, L(l, R)))) & Tip & L(l)");
    write_text("term", "action", "A(f3, 45)");
    write_text("bus", "quiet", "\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3\3");
    write_text("bus", "repeats",
               "\3\3\3\1\2\3\3\3\1\1\2\3\3\3\1\4\1\1\1\377\3\3\3\1\1\2\1\1\377"
               "\1\1\3\3\3\1\1\3\3\3\3\3\3\3");
    return 0;
}
