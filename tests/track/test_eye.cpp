/* The eye on drawn pictures, whose truth is known. */
#include <csetjmp>
#include <cstdarg>
#include <cstdio>
#include <set>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

#include "eye_bench.hpp"
#include "health.hpp"

extern "C" {
#include <cmocka.h>
}

using namespace grrl_sim;
using eye_bench::EyeBench;
using eye_bench::push_across;
using eye_bench::quantile;

static ObjectSpec object_of(const char *text)
{
    Result<ObjectSpec> object = object_from_text(text);
    assert_true(static_cast<bool>(object));
    return *object.value;
}

/* Each link pushed across, to and fro. */
static std::vector<double> errors_of(const char *object, const CameraLook &look, uint64_t seed)
{
    EyeBench bench(object_of(object), look, seed);
    bench.rest();
    int links = static_cast<int>(bench.world().object().links.size());
    for (int i = 0; i < links; i++) {
        bench.push(push_across(bench.world(), i, i % 2 != 0));
        bench.rest();
    }
    return bench.errors_px;
}

static void points_at_rest_are_where_they_were_born(void **)
{
    std::vector<double> all;
    for (uint64_t seed = 1; seed <= 2; seed++) {
        std::vector<double> errors = errors_of(seed % 2 ? "RPR" : "PRP", CameraLook{}, seed);
        assert_true(errors.size() > 50);
        all.insert(all.end(), errors.begin(), errors.end());
    }
    std::printf("error at rest, px: median %.3f, p90 %.3f of %zu\n", quantile(all, 0.5),
                quantile(all, 0.9), all.size());
    assert_true(quantile(all, 0.5) <= 0.15);
    assert_true(quantile(all, 0.9) <= 0.5);
}

static void blur_noise_and_a_bent_lens_do_little(void **)
{
    CameraLook look;
    assert_string_equal(
        parse_camera_look("blur=1.2,noise=4,distortion=-0.05,gradient=0.5", look).c_str(), "");
    std::vector<double> errors = errors_of("RPR", look, 7);
    std::printf("error at rest, px: median %.3f, p90 %.3f of %zu\n", quantile(errors, 0.5),
                quantile(errors, 0.9), errors.size());
    assert_true(errors.size() > 20);
    assert_true(quantile(errors, 0.5) <= 0.15);
    assert_true(quantile(errors, 0.9) <= 0.5);
}

static std::set<int32_t> visible(const EyeBench &bench)
{
    std::set<int32_t> ids;
    for (const grrl_track::Point &point : bench.points())
        if (point.visible)
            ids.insert(point.id);
    return ids;
}

/* The finger covers points at the border of a link, some of which are given up for good since they
 * show the table, too; most others must come back as who they were. */
static void what_the_finger_hid_gets_its_id_back(void **)
{
    CameraLook look;
    ObjectSpec object = object_of("RPR");
    size_t hidden = 0;
    size_t regained = 0;
    for (uint64_t seed = 1; seed <= 4; seed++) {
        EyeBench *bench = nullptr;
        std::set<int32_t> covered;
        std::set<int32_t> known;
        EyeBench made(object, look, seed, [&](bool pushing) {
            std::set<int32_t> now = visible(*bench);
            for (int32_t id : known)
                if (pushing && now.count(id) == 0 && bench->under_finger(id))
                    covered.insert(id);
            if (!pushing)
                known = now;
        });
        bench = &made;
        made.rest();
        for (int link = 0; link < 4; link++) {
            made.push(push_across(made.world(), link, false));
            made.rest();
        }
        for (const grrl_track::Point &point : made.points()) {
            if (covered.count(point.id) == 0)
                continue;
            hidden++;
            Vec2 m =
                made.scene().to_m({static_cast<double>(point.x), static_cast<double>(point.y)});
            bool there = length(m - made.truth(point.id)) < 0.001 * look.mm_per_px;
            regained += point.visible && there;
        }
    }
    std::printf("%zu points hidden, %zu regained their ids\n", hidden, regained);
    assert_true(hidden >= 4);
    assert_true(2 * regained >= hidden);
}

static void the_same_pictures_give_the_same_points(void **)
{
    std::vector<grrl_track::Point> points[2];
    for (auto &seen : points) {
        EyeBench bench(object_of("RR"), CameraLook{}, 5);
        bench.rest();
        bench.push(push_across(bench.world(), 1, false));
        bench.rest();
        seen = bench.points();
    }
    assert_int_equal(points[0].size(), points[1].size());
    for (size_t i = 0; i < points[0].size(); i++) {
        assert_int_equal(points[0][i].id, points[1][i].id);
        assert_true(points[0][i].x == points[1][i].x && points[0][i].y == points[1][i].y);
        assert_int_equal(points[0][i].visible, points[1][i].visible);
    }
}

/* Perception takes what is dense for an object. */
static void the_table_gets_few_points(void **)
{
    CameraLook look;
    EyeBench bench(object_of("RPR"), look, 3);
    bench.rest();
    int on_links = 0;
    int on_table = 0;
    for (const grrl_track::Point &point : bench.points())
        (bench.on_link(point.id) ? on_links : on_table)++;
    std::printf("%d points on links, %d beside them\n", on_links, on_table);
    assert_true(on_links >= 4 * 8);
    assert_true(on_table <= grrl_track::EyeConfig{}.max_sparse + 20);
}

static void an_empty_picture_has_no_points(void **)
{
    grrl_track::Eye eye{grrl_track::EyeConfig{}};
    grrl_track::View view;
    for (int i = 0; i < 3; i++) {
        view.picture = cv::Mat(240, 320, CV_8UC1, cv::Scalar(90));
        eye.look(view);
        assert_int_equal(eye.points().size(), 0);
    }
}

/* A scene of its own begins with ids of its own. */
static void a_new_scene_has_new_ids(void **)
{
    EyeBench bench(object_of("RR"), CameraLook{}, 6);
    cv::Mat picture = bench.scene().draw(bench.world().true_poses(), {}).clone();
    grrl_track::Eye eye{grrl_track::EyeConfig{}};
    grrl_track::View view;
    view.picture = picture;
    eye.look(view);
    int32_t last = eye.points().back().id;
    eye.reset();
    assert_int_equal(eye.points().size(), 0);
    eye.look(view);
    assert_int_equal(eye.points().front().id, last + 1);
}

static std::string complaint_of(const cv::Mat &picture)
{
    std::string text;
    grrl_track::Health health([&text](const std::string &t) { text += t; });
    health.check_picture(picture);
    return text;
}

static void bad_pictures_are_told(void **)
{
    EyeBench bench(object_of("RPR"), CameraLook{}, 2);
    cv::Mat picture = bench.scene().draw(bench.world().true_poses(), {}).clone();
    assert_string_equal(complaint_of(picture).c_str(), "");
    cv::Mat dark = picture * 0.1;
    assert_non_null(std::strstr(complaint_of(dark).c_str(), "dark"));
    cv::Mat blurred;
    cv::GaussianBlur(picture, blurred, cv::Size(), 5.0);
    assert_non_null(std::strstr(complaint_of(blurred).c_str(), "blurred"));
    cv::Mat glaring = picture + cv::Scalar::all(200);
    assert_non_null(std::strstr(complaint_of(glaring).c_str(), "overexposed"));
}

static void a_slow_camera_is_told(void **)
{
    std::string text;
    grrl_track::Health health([&text](const std::string &t) { text += t; });
    for (int i = 0; i < 200; i++)
        health.arrived(33333 * i);
    assert_string_equal(text.c_str(), "");
    for (int i = 0; i < 20; i++)
        health.arrived(200 * 33333 + 500000 * i);
    assert_non_null(std::strstr(text.c_str(), "images per second"));
}

/* Points on the table must not lie so close together that perception takes a group of them for an
 * object: it joins points up to some 50 pixels apart where links have one every 10. */
static void table_points_are_no_object(void **)
{
    const uint64_t seed = trial_seed(901, 18); /* had a group of five */
    EyeBench bench(object_of("RPR"), CameraLook{}, seed);
    bench.rest();
    std::vector<cv::Point2f> table;
    for (const grrl_track::Point &point : bench.points())
        if (point.visible && !bench.on_link(point.id)) {
            for (cv::Point2f other : table)
                assert_true(std::hypot(point.x - other.x, point.y - other.y) > 45.0f);
            table.emplace_back(point.x, point.y);
        }
    assert_true(table.size() > 10);
}

int main()
{
    cv::setNumThreads(1);
    const CMUnitTest tests[] = {
        cmocka_unit_test(points_at_rest_are_where_they_were_born),
        cmocka_unit_test(blur_noise_and_a_bent_lens_do_little),
        cmocka_unit_test(what_the_finger_hid_gets_its_id_back),
        cmocka_unit_test(the_same_pictures_give_the_same_points),
        cmocka_unit_test(the_table_gets_few_points),
        cmocka_unit_test(table_points_are_no_object),
        cmocka_unit_test(an_empty_picture_has_no_points),
        cmocka_unit_test(a_new_scene_has_new_ids),
        cmocka_unit_test(bad_pictures_are_told),
        cmocka_unit_test(a_slow_camera_is_told),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
