/*
 * Tracks and keyframes, against plain lists of all points in double precision. This file defines
 * grrl_bodies_update and grrl_structure_update itself: what is made of the keyframes is not the
 * matter here.
 */

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scene.h"

static int updates_of_bodies;
static int updates_of_structure;

void grrl_bodies_update(struct grrl_perception *p)
{
    assert_true(p == &scene);
    updates_of_bodies++;
}

void grrl_structure_update(struct grrl_perception *p)
{
    assert_true(p == &scene);
    updates_of_structure++;
    assert_int_equal(updates_of_structure, updates_of_bodies);
}

/* --- plain lists
 * ----------------------------------------------------------------------------------- */

enum { WINDOW_FRAMES = 60 };

struct heap {
    int n;
    struct point point[WINDOW_FRAMES];
};

struct track {
    int32_t id;
    struct point last;
    struct point before;
    long last_frame;
    int jumps;
    struct heap heap[2];
};

struct picture {
    struct point point[GRRL_MAX_FEATURES];
    int weight[GRRL_MAX_FEATURES];
    bool at_rest;
};

static struct {
    int n_tracks;
    struct track track[GRRL_MAX_FEATURES];
    int n_pictures;
    struct picture picture[GRRL_MAX_KEYFRAMES];
    int window_frames;
    bool moving;
    bool rest_open;
    long frames;
    struct grrl_perception_counts counts;
} plain;

static double jump(void)
{
    return (double)scene.config.jump_m;
}

static double noise(void)
{
    return (double)scene.config.noise_m;
}

static double distance(struct point a, struct point b)
{
    return sqrt(square(minus(a, b)));
}

static struct point mean_of_heap(const struct heap *heap)
{
    struct point sum = {0.0, 0.0};
    for (int i = 0; i < heap->n; i++)
        sum =
            (struct point){sum.x + heap->point[i].x / heap->n, sum.y + heap->point[i].y / heap->n};
    return sum;
}

static const struct heap *larger(int slot)
{
    const struct heap *heap = plain.track[slot].heap;
    return heap[1].n > heap[0].n ? &heap[1] : &heap[0];
}

static void forget(int slot)
{
    for (int k = 0; k < plain.n_pictures; k++)
        plain.picture[k].weight[slot] = 0;
    plain.track[slot].heap[0].n = plain.track[slot].heap[1].n = 0;
    plain.track[slot].jumps = 0;
}

static int find_track(int32_t id)
{
    for (int i = 0; i < plain.n_tracks; i++)
        if (plain.track[i].id == id)
            return i;
    return -1;
}

/* A new slot, or the first that nothing remembers; -1: there is none. */
static int new_track(int32_t id)
{
    int slot = plain.n_tracks;
    if (slot == GRRL_MAX_FEATURES) {
        bool remembered = true;
        for (slot = 0; slot < plain.n_tracks && remembered; slot++) {
            remembered =
                plain.track[slot].heap[0].n > 0 || plain.track[slot].last_frame + 1 >= plain.frames;
            for (int k = 0; k < plain.n_pictures; k++)
                remembered = remembered || plain.picture[k].weight[slot] > 0;
        }
        if (remembered)
            return -1;
        slot--;
    } else {
        plain.n_tracks++;
    }
    plain.track[slot].id = id;
    forget(slot);
    return slot;
}

static void put_on_heap(struct track *track, struct point point)
{
    double reach = plain.moving ? jump() : 6.0 * noise();
    for (int h = 0; h < 2; h++) {
        struct heap *heap = &track->heap[h];
        bool near = heap->n > 0 && distance(point, mean_of_heap(heap)) < reach;
        if (!near && (heap->n == 0 || (h == 1 && heap->n == 1)))
            heap->n = 0;
        if (near || heap->n == 0) {
            heap->point[heap->n++] = point;
            return;
        }
    }
}

static void take_point(int32_t id, struct point point)
{
    double limit = (double)scene.config.table_m;
    if (!(fabs(point.x) < limit && fabs(point.y) < limit)) {
        plain.counts.refused++;
        return;
    }
    int slot = find_track(id);
    bool is_new = slot < 0;
    slot = is_new ? new_track(id) : slot;
    if (slot < 0) {
        plain.counts.overflow++;
        return;
    }
    struct track *track = &plain.track[slot];
    double reach =
        jump() *
        (double)(plain.frames - track->last_frame > 1 ? 2 : plain.frames - track->last_frame);
    if (!is_new && distance(point, track->last) > reach && distance(point, track->before) > reach) {
        plain.counts.outliers++;
        if (++track->jumps < 5)
            return;
        forget(slot);
        is_new = true;
    }
    track->jumps = 0;
    track->before = is_new ? point : track->last;
    track->last = point;
    track->last_frame = plain.frames;
    put_on_heap(track, point);
}

static void take_frame(const struct grrl_frame *frame)
{
    for (uint32_t i = 0; i < frame->n; i++)
        take_point(frame->id[i], (struct point){(double)frame->x_m[i], (double)frame->y_m[i]});
    plain.window_frames++;
    if (plain.n_tracks > plain.counts.features_high)
        plain.counts.features_high = (uint16_t)plain.n_tracks;
}

static void clear_window(void)
{
    for (int i = 0; i < GRRL_MAX_FEATURES; i++)
        plain.track[i].heap[0].n = plain.track[i].heap[1].n = 0;
    plain.window_frames = 0;
}

static int moved_from(const struct picture *picture, double far)
{
    int n = 0;
    for (int i = 0; i < plain.n_tracks; i++)
        n += picture->weight[i] > 0 && larger(i)->n > 0 &&
             distance(mean_of_heap(larger(i)), picture->point[i]) > far;
    return n;
}

/* Whether a quarter of what is seen, and three at least, is in no picture. */
static bool much_is_new(void)
{
    int seen = 0;
    int fresh = 0;
    for (int i = 0; i < plain.n_tracks; i++) {
        bool drawn = false;
        for (int k = 0; k < plain.n_pictures; k++)
            drawn = drawn || plain.picture[k].weight[i] > 0;
        seen += larger(i)->n > 0;
        fresh += larger(i)->n > 0 && !drawn;
    }
    return fresh >= 3 && 4 * fresh >= seen;
}

static double novelty(int k)
{
    double sum = 0.0;
    for (int i = 0; i < plain.n_tracks; i++)
        if (plain.picture[k].weight[i] > 0 && plain.picture[k - 1].weight[i] > 0)
            sum += square(minus(plain.picture[k].point[i], plain.picture[k - 1].point[i]));
    return plain.picture[k].at_rest ? 2.0 * sum : sum;
}

static struct picture *new_picture(void)
{
    if (plain.n_pictures == GRRL_MAX_KEYFRAMES) {
        int least = 1;
        for (int k = 2; k < plain.n_pictures; k++)
            least = novelty(k) < novelty(least) ? k : least;
        for (int k = least; k + 1 < plain.n_pictures; k++)
            plain.picture[k] = plain.picture[k + 1];
        plain.n_pictures--;
        plain.counts.thinned++;
    }
    plain.n_pictures++;
    if (plain.n_pictures > plain.counts.keyframes_high)
        plain.counts.keyframes_high = (uint16_t)plain.n_pictures;
    return &plain.picture[plain.n_pictures - 1];
}

static void draw(struct picture *picture, bool at_rest)
{
    int seen = 0;
    int complete = 0;
    for (int i = 0; i < plain.n_tracks; i++) {
        seen += larger(i)->n > 0;
        complete += larger(i)->n >= plain.window_frames;
    }
    bool all_frames = !at_rest && 3 * complete >= seen;
    memset(picture, 0, sizeof *picture);
    picture->at_rest = at_rest;
    for (int i = 0; i < plain.n_tracks; i++) {
        int n = larger(i)->n;
        picture->point[i] = mean_of_heap(larger(i));
        picture->weight[i] = all_frames && n < plain.window_frames ? 0 : n;
    }
}

static void join(struct picture *picture)
{
    for (int i = 0; i < plain.n_tracks; i++) {
        struct point mean = mean_of_heap(larger(i));
        double a = picture->weight[i];
        double b = larger(i)->n;
        if (!(b > 0.0))
            continue;
        picture->point[i] = (struct point){(a * picture->point[i].x + b * mean.x) / (a + b),
                                           (a * picture->point[i].y + b * mean.y) / (a + b)};
        picture->weight[i] = (int)fmin(a + b, 60.0);
    }
}

static void end_rest(void)
{
    if (plain.window_frames == 0)
        return;
    struct picture *last = &plain.picture[plain.n_pictures > 0 ? plain.n_pictures - 1 : 0];
    if (plain.rest_open) {
        draw(last, true);
    } else if (plain.n_pictures > 0 && last->at_rest && moved_from(last, 4.0 * noise()) == 0) {
        join(last);
        clear_window();
    } else {
        draw(new_picture(), true);
        plain.rest_open = true;
    }
}

static bool slides(const struct grrl_frame *frame)
{
    int away = 0;
    int seen = 0;
    for (uint32_t i = 0; i < frame->n; i++) {
        struct point point = {(double)frame->x_m[i], (double)frame->y_m[i]};
        int slot = find_track(frame->id[i]);
        if (slot >= 0 && larger(slot)->n > 0) {
            seen++;
            away += distance(point, mean_of_heap(larger(slot))) > 6.0 * noise();
        }
    }
    return away >= 3 && 10 * away > seen;
}

static void plain_observe(const struct grrl_frame *frame, bool pushing)
{
    plain.frames++;
    plain.counts.frames++;
    if (pushing && !plain.moving)
        end_rest();
    bool anew =
        pushing ? !plain.moving
                : plain.moving || (!plain.rest_open && plain.window_frames > 0 && slides(frame));
    if (anew) {
        clear_window();
        plain.rest_open = false;
    }
    plain.moving = pushing;
    if (pushing || plain.window_frames < WINDOW_FRAMES)
        take_frame(frame);
    if (pushing && plain.window_frames == 3) {
        if (plain.n_pictures == 0 ||
            moved_from(&plain.picture[plain.n_pictures - 1], (double)scene.config.keyframe_m) >=
                3 ||
            much_is_new())
            draw(new_picture(), false);
        clear_window();
    }
}

/* --- comparison
 * ------------------------------------------------------------------------------------ */

#define NEAR_M 3e-6

static void assert_same(void)
{
    assert_int_equal(scene.n_slots, plain.n_tracks);
    assert_int_equal(scene.n_keyframes, plain.n_pictures);
    assert_int_equal(scene.window.frames, plain.window_frames);
    assert_int_equal(scene.moving, plain.moving);
    assert_int_equal(scene.rest_open, plain.rest_open);
    assert_memory_equal(&scene.counts, &plain.counts, sizeof scene.counts);
    for (int i = 0; i < plain.n_tracks; i++) {
        const struct track *track = &plain.track[i];
        assert_int_equal(scene.id[i], track->id);
        assert_int_equal(scene.jumps[i], track->jumps);
        assert_int_equal(scene.last_frame[i], track->last_frame);
        assert_at(scene.last[i], track->last, NEAR_M);
        assert_at(scene.before[i], track->before, NEAR_M);
        assert_int_equal(scene.window.heap[0][i].n, track->heap[0].n);
        assert_int_equal(scene.window.heap[1][i].n, track->heap[1].n);
    }
    for (int k = 0; k < plain.n_pictures; k++) {
        const struct picture *picture = &plain.picture[k];
        assert_int_equal(scene.keyframe[k].at_rest, picture->at_rest);
        for (int i = 0; i < plain.n_tracks; i++) {
            assert_int_equal(scene.keyframe[k].weight[i], picture->weight[i]);
            if (picture->weight[i] > 0)
                assert_at(scene.keyframe[k].point[i], picture->point[i], NEAR_M);
        }
    }
}

/* --- a stream of points
 * ---------------------------------------------------------------------------- */

enum { MAX_IDS = GRRL_MAX_FEATURES + 40, MAX_POINTS = MAX_IDS + 4 };

static struct {
    int n;
    int32_t id[MAX_IDS];
    struct point place[MAX_IDS];
    bool moves[MAX_IDS];
    double missing;
    double outliers;
    double wrong;
    int shown; /* how many of the n are in view, from `first` on */
    int first;
} stream;

static int32_t frame_id[MAX_POINTS];
static float frame_x[MAX_POINTS];
static float frame_y[MAX_POINTS];

static void start_stream(int n, double missing, double outliers)
{
    struct grrl_perception_config config;
    (void)scene_start(0);
    config = scene.config;
    config.table_m = 2.0f;
    assert_int_equal(grrl_perception_init(&scene, &config), GRRL_OK);
    memset(&plain, 0, sizeof plain);
    updates_of_bodies = updates_of_structure = 0;
    stream.n = stream.shown = n;
    stream.first = 0;
    stream.missing = missing;
    stream.outliers = outliers;
    stream.wrong = 0.1;
    for (int i = 0; i < n; i++) {
        stream.id[i] = (int32_t)grrl_random_next(&scene_random);
        stream.place[i] = (struct point){scene_uniform(-1.0, 1.0), scene_uniform(-1.0, 1.0)};
        stream.moves[i] = scene_chance(0.5);
    }
}

static struct grrl_frame next_frame(double speed)
{
    uint32_t n = 0;
    for (int s = 0; s < stream.shown; s++) {
        int i = (stream.first + s) % stream.n;
        double far = scene_chance(stream.outliers) ? scene_uniform(0.0, 0.08) : 0.0;
        if (stream.moves[i])
            stream.place[i].x += speed * (stream.place[i].x > 0.9 ? -400.0 : 1.0);
        if (scene_chance(stream.missing))
            continue;
        frame_id[n] = stream.id[i];
        frame_x[n] = (float)(stream.place[i].x + far + noise() * scene_normal());
        frame_y[n] = (float)(stream.place[i].y + noise() * scene_normal());
        n++;
        if (scene_chance(0.01 * stream.wrong)) { /* twice in a frame */
            frame_id[n] = stream.id[i];
            frame_x[n] = frame_x[n - 1];
            frame_y[n] = frame_y[n - 1] + (float)scene_uniform(0.0, 0.001);
            n += n + 1 < MAX_POINTS;
        }
    }
    if (n > 0 && scene_chance(stream.wrong)) {
        static const float wrong[] = {NAN, INFINITY, -INFINITY, 2.0f, -2.0f, 1e9f};
        float *axis = scene_chance(0.5) ? frame_x : frame_y;
        axis[grrl_random_below(&scene_random, n)] = wrong[scene_int(0, 5)];
    }
    return (struct grrl_frame){n, frame_id, frame_x, frame_y};
}

static void show(int frames, double speed, bool pushing)
{
    for (int f = 0; f < frames; f++) {
        struct grrl_frame frame = next_frame(speed);
        grrl_perception_observe(&scene, &frame, pushing);
        plain_observe(&frame, pushing);
        assert_same();
    }
}

static void update(void)
{
    int before = updates_of_bodies;
    enum grrl_status status = grrl_perception_update(&scene);
    end_rest();
    assert_same();
    bool any = plain.n_pictures > 0 && plain.n_tracks > 0;
    assert_int_equal(status, any ? GRRL_OK : GRRL_ERR_NONE);
    assert_int_equal(updates_of_bodies, before + any);
    assert_int_equal(updates_of_structure, updates_of_bodies);
}

/* Pushes and rests of all kinds; ids that come and go. */
static void run_stream(int phases)
{
    for (int phase = 0; phase < phases; phase++) {
        static const double speeds[] = {0.0, 0.0001, 0.0005, 0.002, 0.008};
        bool pushing = scene_chance(0.5);
        double speed = pushing ? speeds[scene_int(0, 4)] : speeds[scene_chance(0.2) ? 2 : 0];
        int most = scene_chance(0.05) ? 70 : 12;
        show(scene_int(1, most), speed, pushing);
        if (scene_chance(0.5))
            update();
        if (scene_chance(0.1)) {
            stream.first = scene_int(0, stream.n - 1);
            stream.shown = scene_int(stream.n / 2, stream.n);
        }
        if (scene_chance(0.2)) { /* to another place, for long */
            int i = scene_int(0, stream.n - 1);
            stream.place[i] = (struct point){scene_uniform(-1.0, 1.0), scene_uniform(-1.0, 1.0)};
        }
    }
}

static void tracks_and_keyframes_of_random_streams(void **state)
{
    (void)state;
    scene_seed("tracks_and_keyframes_of_random_streams");
    unsigned thinned = 0;
    for (int run = 0; run < 40; run++) {
        start_stream(scene_int(1, 40), run % 2 == 0 ? scene_uniform(0.0, 0.5) : 0.0,
                     run % 3 == 0 ? 0.03 : 0.0);
        run_stream(run % 10 == 0 ? 200 : 60);
        thinned += scene.counts.thinned;
    }
    print_message("%u keyframes thinned\n", thinned);
    assert_true(thinned > 20);
}

static void tracks_at_capacity(void **state)
{
    (void)state;
    scene_seed("tracks_at_capacity");
    start_stream(MAX_IDS, 0.0, 0.001);
    stream.wrong = 0.0;
    show(3, 0.0, false);
    assert_true(scene.counts.overflow >= 3 * 40);
    assert_int_equal(scene.counts.features_high, GRRL_MAX_FEATURES);
    stream.shown = MAX_IDS / 2;
    uint32_t overflow = 0;
    for (int i = 0; i < 5; i++) {
        stream.first = scene_int(0, MAX_IDS - 1);
        run_stream(12);
        overflow = scene.counts.overflow;
    }
    assert_true(overflow > 3 * 40);
    /* ids that no keyframe remembers make room */
    start_stream(MAX_IDS, 0.0, 0.0);
    stream.wrong = 0.0;
    stream.shown = GRRL_MAX_FEATURES;
    show(1, 0.0, true); /* in no keyframe */
    stream.first = 40;
    show(2, 0.0, false);
    assert_int_equal(scene.counts.overflow, 40);
    show(1, 0.0, false);
    assert_int_equal(scene.counts.overflow, 40);
    /* but for those that one does */
    start_stream(MAX_IDS, 0.0, 0.0);
    stream.wrong = 0.0;
    stream.shown = 5;
    show(5, 0.0, false);
    stream.shown = GRRL_MAX_FEATURES;
    show(1, 0.0, true);
    stream.first = 40;
    show(4, 0.0, false);
    assert_int_equal(scene.n_keyframes, 1);
    assert_int_equal(scene.counts.overflow, 40 + 3 * 5);
    /* one frame of a rest is enough to be remembered by */
    start_stream(MAX_IDS, 0.0, 0.0);
    stream.wrong = 0.0;
    stream.shown = GRRL_MAX_FEATURES;
    show(1, 0.0, false);
    show(1, 0.0, true);
    stream.first = 40;
    show(4, 0.0, false);
    assert_int_equal(scene.counts.overflow, 4 * 40);
    /* nothing to be seen */
    start_stream(1, 0.0, 0.0);
    stream.shown = 0;
    show(5, 0.0, false);
    update();
    start_stream(1, 0.0, 0.0);
    update();
    run_stream(20);
}

/* Rests that are one, for ever: no more than sixty frames of each count. */
static void long_rests_are_one_keyframe(void **state)
{
    (void)state;
    scene_seed("long_rests_are_one_keyframe");
    start_stream(10, 0.0, 0.0);
    stream.wrong = 0.0;
    for (int i = 0; i < 5; i++) {
        show(40, 0.0, false);
        update();
        show(9, 0.0, true);
    }
    assert_int_equal(scene.n_keyframes, 1);
    int heaviest = 0;
    for (int i = 0; i < scene.n_slots; i++)
        heaviest = scene.keyframe[0].weight[i] > heaviest ? scene.keyframe[0].weight[i] : heaviest;
    assert_int_equal(heaviest, 60);
    show(150, 0.0, false);
    assert_int_equal(scene.window.frames, 60);
}

/* A feature that was forgotten belongs to nothing. */
static void restarted_tracks_belong_to_nothing(void **state)
{
    (void)state;
    scene_seed("restarted_tracks_belong_to_nothing");
    start_stream(1, 0.0, 0.0);
    stream.wrong = 0.0;
    show(5, 0.0, false);
    scene.body_of[0] = 3;
    scene.blob_of[0] = 4;
    stream.place[0] = (struct point){0.0, 1.5};
    show(4, 0.0, false);
    assert_int_equal(scene.body_of[0], 3);
    assert_int_equal(scene.counts.outliers, 4);
    show(1, 0.0, false);
    assert_int_equal(scene.body_of[0], GRRL_FEATURE_NONE);
    assert_int_equal(scene.blob_of[0], 0);
    assert_int_equal(scene.counts.outliers, 5);
}

/* A reset forgets all but configuration and counts. */
static void reset_keeps_configuration_and_counts(void **state)
{
    (void)state;
    static struct grrl_perception fresh;
    scene_seed("reset_keeps_configuration_and_counts");
    start_stream(20, 0.1, 0.1);
    run_stream(10);
    struct grrl_perception_counts counts = scene.counts;
    struct grrl_perception_config config = scene.config;
    assert_true(grrl_perception_model(&scene) == &scene.model);
    grrl_perception_reset(&scene);
    memset(&fresh, 0, sizeof fresh);
    fresh.config = config;
    fresh.counts = counts;
    assert_memory_equal(&scene, &fresh, sizeof scene);
    assert_int_equal(grrl_perception_update(&scene), GRRL_ERR_NONE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tracks_and_keyframes_of_random_streams),
        cmocka_unit_test(tracks_at_capacity),
        cmocka_unit_test(long_rests_are_one_keyframe),
        cmocka_unit_test(restarted_tracks_belong_to_nothing),
        cmocka_unit_test(reset_keeps_configuration_and_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
