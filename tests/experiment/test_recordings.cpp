/* The truth of synthetic recordings, how answers are scored, and the methods on easy ones. */

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>

extern "C" {
#include <cmocka.h>
}

#include <algorithm>
#include <cmath>
#include <map>

#include "recordings/figures.hpp"
#include "recordings/grid.hpp"
#include "recordings/joint_error.hpp"
#include "recordings/json.hpp"
#include "recordings/merging.hpp"
#include "recordings/methods.hpp"
#include "recordings/score.hpp"

using namespace grrl_experiment;
using namespace grrl_experiment::recordings;

namespace
{

std::vector<grrl_sim::Pose> relative_poses(const Scene &scene, size_t a, size_t b)
{
    std::vector<grrl_sim::Pose> poses;
    for (int i = 0; i <= 40; i++) {
        std::vector<Placed> placed = scene.at(i / 40.0);
        poses.push_back(compose(inverse(placed[a].pose), placed[b].pose));
    }
    return poses;
}

const Joint *joint_between(const Scene &scene, size_t a, size_t b)
{
    for (const Joint &joint : scene.joints)
        if (joint.a == static_cast<int>(a) && joint.b == static_cast<int>(b))
            return &joint;
    return nullptr;
}

/* How far a joint moves from a time on, or up to one. */
double range_of(const Joint &joint, double begin, double end)
{
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int i = 0; i <= 100; i++) {
        double value = joint.value(begin + (end - begin) * i / 100.0);
        low = std::min(low, value);
        high = std::max(high, value);
    }
    return high - low;
}

/* Joints hold exactly and move enough; nothing else looks like a joint. */
void test_scenes(void **)
{
    for (const NamedObject &object : all_objects()) {
        bool close = object.object == Object::CROSSING || object.object == Object::NEARER ||
                     object.object == Object::HAND;
        for (uint64_t seed = 1; seed <= 40; seed++) {
            Scene scene = make_scene(object.object, 0.3, seed);
            for (size_t b = 1; b < scene.bodies.size(); b++) {
                for (size_t a = 0; a < b; a++) {
                    JointErrors errors = joint_errors(relative_poses(scene, a, b));
                    double axis = std::hypot(errors.line_m, 0.15 * errors.turn_rad);
                    const Joint *joint = joint_between(scene, a, b);
                    if (joint == nullptr) {
                        assert_true(close || std::min(errors.pivot_m, axis) > 0.03 * 0.3);
                        continue;
                    }
                    bool turns = joint->type == GRRL_REVOLUTE;
                    double least = turns ? grrl_sim::radians(20.0) : 0.03;
                    assert_true((turns ? errors.pivot_m : axis) < 1e-6);
                    if (object.object != Object::HAND) {
                        assert_true(range_of(*joint, 0.33, 1.0) > 0.93 * least);
                        assert_true(range_of(*joint, 0.0, 0.67) > 0.93 * least);
                    }
                }
            }
        }
    }
}

/* What a perfect method says. */
Estimate truth_of(const Recording &recording)
{
    Estimate estimate;
    estimate.links = recording.bodies;
    for (size_t id = 0; id < recording.tracks.size(); id++)
        estimate.features.push_back({static_cast<int32_t>(id), recording.tracks[id].body});
    for (const Joint &joint : recording.joints)
        estimate.joints.push_back({joint.b, joint.a, joint.type, 0.97});
    return estimate;
}

/* The same seed gives the same recording, and each of them its truth. */
void test_recordings(void **)
{
    grrl_sim::Result<std::vector<Cell>> cells = make_grid("");
    assert_true(static_cast<bool>(cells));
    assert_int_equal(cells.value->size(), 27 * all_objects().size());
    for (const Cell &cell : *cells.value) {
        Recording recording = record(cell.what, 7);
        assert_true(csv_of(recording) == csv_of(record(cell.what, 7)));
        assert_int_equal(recording.frames.size(), 4 * cell.what.rate_hz + 1);
        Score best = score(recording, truth_of(recording));
        assert_true(best.right && best.missed == 0 && best.false_called == 0);
        auto asked =
            static_cast<size_t>(std::count(recording.open.begin(), recording.open.end(), false));
        assert_true(best.error == 0.0 && best.called.size() == asked);
    }
}

void test_score(void **)
{
    Conditions what;
    what.object = Object::RR;
    Recording recording = record(what, 3);
    Estimate estimate = truth_of(recording);
    estimate.joints[0].type =
        estimate.joints[0].type == GRRL_REVOLUTE ? GRRL_PRISMATIC : GRRL_REVOLUTE;
    Score wrong_type = score(recording, estimate);
    assert_true(wrong_type.bodies_right && !wrong_type.right);
    assert_int_equal(wrong_type.missed, 1);
    assert_int_equal(wrong_type.false_called, 1);
    assert_int_equal(wrong_type.false_sure, 1);

    estimate = truth_of(recording);
    estimate.joints[1].probability = 0.4;
    assert_int_equal(score(recording, estimate).missed, 1);
    estimate.joints.push_back({1, 3, GRRL_REVOLUTE, 0.6}); /* of the first link to the last */
    Score extra = score(recording, estimate);
    assert_true(extra.false_called == 1 && extra.false_sure == 0);

    estimate = truth_of(recording); /* half of a link as a body of its own, hinged to the other */
    estimate.links++;
    int moved = 0;
    for (auto &[id, link] : estimate.features)
        if (link == 2 && moved++ % 2 == 0)
            link = 4;
    estimate.joints.push_back({2, 4, GRRL_REVOLUTE, 0.99});
    Score split = score(recording, estimate);
    assert_true(!split.bodies_right && split.error == 0.0 && split.false_sure == 1);

    estimate = truth_of(recording); /* two links as one */
    for (auto &[id, link] : estimate.features)
        link = link == 3 ? 2 : link;
    Score merged = score(recording, estimate);
    assert_true(!merged.bodies_right && merged.error > 0.1);
    assert_false(score(recording, Estimate()).right);
}

void test_json(void **)
{
    std::optional<Json> json =
        read_json(" {\"a\": [1, -2.5e1, true, null, []], \"b\": {\"c\": \"x\\\"y\"}, \"d\": {}} ");
    assert_true(json.has_value());
    assert_int_equal((*json)["a"].items.size(), 5);
    assert_true((*json)["a"].items[1].number == -25.0 && (*json)["a"].items[2].number == 1.0);
    assert_string_equal((*json)["b"]["c"].text.c_str(), "x\\\"y");
    assert_true((*json)["d"].items.empty() && (*json)["e"].text.empty());
    std::string deep(100, '[');
    for (const char *wrong : {"", "{", "[1", "[1 2]", "{\"a\" 1}", "{a: 1}", "\"x", "1 2", "[1,]",
                              "{\"a\":}", deep.c_str()})
        assert_false(read_json(wrong).has_value());
}

void test_grid(void **)
{
    auto cells = make_grid("camera=roll,zoom; objects=R,two ;tracks");
    assert_int_equal(cells.value->size(), 2 * 2 * 6);
    assert_string_equal(cells.value->front().conditions.c_str(), "camera=roll");
    assert_string_equal(cells.value->back().conditions.c_str(), "camera=zoom,tracks=frozen");
    assert_int_equal(make_grid("size; camera; objects=R").value->size(), 3 * 8 + 4);
    for (const char *wrong : {"camra", "camera=", "camera=left", "size=2m;camera=roll", "rate=31"})
        assert_false(static_cast<bool>(make_grid(wrong)));
}

/* Of a camera at rest are the mechanisms with the usual camera, whether an axis names it or not. */
void test_figures_of_a_camera_at_rest(void **)
{
    auto cells = make_grid("camera=fixed,roll; objects=R,two; rate=30,3");
    auto usual = make_grid("objects=R,two; tracks=whole,late");
    for (const Cell &cell : *usual.value)
        cells.value->push_back(cell);
    std::vector<Result> results;
    for (const Cell &cell : *cells.value) {
        results.emplace_back();
        results.back().cell = &cell;
        Score &score = results.back().of[OURS].score;
        score.joints = 1;
        score.right = cell.what.camera == Camera::FIXED;
    }
    Figures f = figures(results, OURS, "", "");
    assert_int_equal(f.recordings, 2 * 2 * 2 + 2 * 2);
    assert_int_equal(f.right.of, 6); /* R alone is a mechanism */
    assert_int_equal(f.fixed.of, 4);
    assert_int_equal(f.fixed.part, 4);
    assert_int_equal(figures(results, OURS, "camera=roll,rate=3", "R").fixed.of, 0);
}

/* Merging by BIC finds what nothing disturbs. */
void test_merging(void **)
{
    int right = 0;
    const Object objects[] = {Object::R, Object::P, Object::DOOR, Object::TWO, Object::THREE};
    for (Object object : objects) {
        for (uint64_t seed = 1; seed <= 4; seed++) {
            Conditions what;
            what.object = object;
            Recording recording = record(what, seed);
            right += score(recording, ask_bic(recording).estimate).right;
        }
    }
    assert_true(right >= 16);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(test_scenes),  cmocka_unit_test(test_recordings),
        cmocka_unit_test(test_score),   cmocka_unit_test(test_json),
        cmocka_unit_test(test_grid),    cmocka_unit_test(test_figures_of_a_camera_at_rest),
        cmocka_unit_test(test_merging),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
