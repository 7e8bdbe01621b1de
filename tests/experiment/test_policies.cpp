/* The policies that are not the library's, and what measures them, on models made by hand. */
#include <cmath>
#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

#include "chooser.hpp"
#include "clairvoyant.hpp"
#include "motion.hpp"
#include "policies.hpp"
#include "rule.hpp"
#include "truth.hpp"

extern "C" {
#include <cmocka.h>
}

using namespace grrl_experiment;

namespace
{

/* Bodies along x with a feature at each end and one in the middle; lengths in metres. */
grrl_model row_of(const std::vector<float> &lengths)
{
    grrl_model model{};
    float x = 0.0f;
    for (float length : lengths) {
        grrl_body &body = model.body[model.n_bodies];
        body.number = static_cast<uint16_t>(model.n_bodies + 1);
        body.n_features = 3;
        body.centroid_m = {x + 0.5f * length, 0.0f};
        body.axis = {1.0f, 0.0f};
        body.length_m = length;
        body.width_m = 0.03f;
        for (float share : {0.0f, 0.5f, 1.0f}) {
            model.feature_id[model.n_features] = model.n_features;
            model.feature_m[model.n_features] = {x + share * length, 0.0f};
            model.feature_body[model.n_features] = model.n_bodies;
            model.n_features++;
        }
        model.n_bodies++;
        x += length;
    }
    return model;
}

void join(grrl_model &model, uint8_t a, uint8_t b, grrl_joint_type type)
{
    grrl_joint &joint = model.joint[model.n_joints++];
    joint.a = a;
    joint.b = b;
    joint.type = static_cast<uint8_t>(type);
    joint.p_revolute = type == GRRL_REVOLUTE ? 1.0f : 0.0f;
    joint.p_prismatic = 1.0f - joint.p_revolute;
    joint.probability = 0.6f; /* and so 0.4 of its motion is news */
    joint.point_m = {model.body[b].centroid_m.x - 0.5f * model.body[b].length_m, 0.0f};
    joint.axis = {type == GRRL_PRISMATIC ? 1.0f : 0.0f, 0.0f};
}

void the_rule_takes_the_longest_along_its_axis_first(void **)
{
    grrl_model model = row_of({0.1f, 0.3f, 0.2f});
    std::unique_ptr<Chooser> rule = make_rule("aps");
    const int expected[] = {0, 180, 90, 270, 45, 225};
    for (int number : {2, 3, 1})
        for (int degrees : expected) {
            Action action = rule->choose(model);
            assert_int_equal(action.body_number, number);
            assert_int_equal(grrl_direction_deg[action.direction], degrees);
        }
    assert_int_equal(rule->choose(model).body_number, 2); /* all over again */
    assert_int_equal(rule->choose(model).direction, 3);
    join(model, 0, 1, GRRL_REVOLUTE); /* another structure: nothing was tried in it */
    assert_int_equal(rule->choose(model).direction, 0);
    rule->begin_trial();
    assert_int_equal(rule->choose(model).direction, 0);
}

void the_rule_has_six_orders(void **)
{
    grrl_model model = row_of({0.1f});
    const struct {
        const char *name;
        int degrees[GRRL_DIRECTIONS];
    } cases[] = {
        {"rule", {0, 180, 90, 270, 45, 225}},     {"rule-asp", {0, 180, 45, 225, 90, 270}},
        {"rule-pas", {90, 270, 0, 180, 45, 225}}, {"rule-psa", {90, 270, 45, 225, 0, 180}},
        {"rule-sap", {45, 225, 0, 180, 90, 270}}, {"rule-spa", {45, 225, 90, 270, 0, 180}}};
    for (const auto &c : cases) {
        std::unique_ptr<Chooser> rule = find_policy(c.name)->make_chooser(nullptr, 1);
        for (int degrees : c.degrees)
            assert_int_equal(grrl_direction_deg[rule->choose(model).direction], degrees);
    }
}

void motion_is_expected_where_joints_allow_it(void **)
{
    grrl_model model = row_of({0.1f, 0.1f});
    for (uint8_t direction : {uint8_t{0}, uint8_t{2}})
        assert_true(std::abs(expected_motion(model, 0, direction) - 0.5) < 0.01);
    assert_true(expected_motion(model, 0, 1) < 0.4); /* at 45 degrees it slides off */
    join(model, 0, 1, GRRL_REVOLUTE);
    assert_true(std::abs(expected_motion(model, 0, 2) - expected_motion(model, 0, 0) - 0.4) < 0.01);
    model.n_joints = 0;
    join(model, 0, 1, GRRL_PRISMATIC);
    assert_true(std::abs(expected_motion(model, 0, 0) - expected_motion(model, 0, 2) - 0.4) < 0.01);
    assert_true(expected_motion(row_of({0.1f, 0.4f}), 1, 0) > 1.9); /* three more may hide in it */
}

void motion_repeats_no_push_in_a_structure(void **)
{
    grrl_model model = row_of({0.1f, 0.2f});
    join(model, 0, 1, GRRL_REVOLUTE);
    std::unique_ptr<Chooser> motion = make_motion();
    std::set<std::pair<int, int>> seen;
    for (int i = 0; i < 2 * GRRL_DIRECTIONS; i++) {
        Action action = motion->choose(model);
        seen.insert({action.body_number, action.direction});
    }
    assert_int_equal(seen.size(), 2 * GRRL_DIRECTIONS);
}

/* The model that sees every link of a world as it is, without joints. */
grrl_model perfect(const grrl_sim::World &world)
{
    grrl_model model{};
    std::vector<grrl_sim::Pose> poses = world.true_poses();
    model.n_bodies = static_cast<uint8_t>(poses.size());
    for (size_t i = 0; i < poses.size(); i++) {
        grrl_body &body = model.body[i];
        body.number = static_cast<uint16_t>(i + 1);
        body.centroid_m = {static_cast<float>(poses[i].position.x),
                           static_cast<float>(poses[i].position.y)};
        grrl_sim::Vec2 axis = grrl_sim::direction(poses[i].angle);
        body.axis = {static_cast<float>(axis.x), static_cast<float>(axis.y)};
        body.length_m = 0.13f;
    }
    for (int id = 0; id < world.tracker().feature_count(); id++) {
        int link = world.tracker().true_link(static_cast<uint32_t>(id));
        grrl_sim::Vec2 at = world.tracker().true_position(static_cast<uint32_t>(id), poses);
        model.feature_id[id] = id;
        model.feature_m[id] = {static_cast<float>(at.x), static_cast<float>(at.y)};
        model.feature_body[id] =
            link < 0 ? static_cast<uint8_t>(GRRL_FEATURE_BACKGROUND) : static_cast<uint8_t>(link);
        model.n_features++;
        if (link >= 0)
            model.body[link].n_features++;
    }
    return model;
}

grrl_sim::World world_of(const char *text)
{
    return grrl_sim::World(*grrl_sim::object_from_text(text).value, grrl_sim::WorldParams{}, 3);
}

void joints_are_known_or_wrong_by_the_truth(void **)
{
    grrl_sim::World world = world_of("RPR");
    grrl_model model = perfect(world);
    join(model, 0, 1, GRRL_REVOLUTE);
    join(model, 1, 2, GRRL_REVOLUTE); /* is prismatic */
    join(model, 0, 3, GRRL_REVOLUTE); /* is none */
    Estimate estimate = estimate_of(model);
    assert_true(known_joints(world, estimate) == std::vector<bool>({true, false, false}));
    assert_true(wrong_joints(world, estimate) == std::vector<bool>({false, true, true}));
}

void joints_between_clusters_of_links_count(void **)
{
    grrl_sim::World world = world_of("RPR");
    Estimate estimate = estimate_of(perfect(world));
    estimate.links = 2; /* links 0 and 1, links 2 and 3 not told apart */
    for (auto &feature : estimate.features)
        feature.second /= 2;
    estimate.joints = {{0, 1, GRRL_PRISMATIC, 1.0}};
    assert_true(known_joints(world, estimate) == std::vector<bool>({false, true, false}));
    assert_true(wrong_joints(world, estimate) == std::vector<bool>({false}));
}

void the_clairvoyant_goes_for_what_is_not_known(void **)
{
    grrl_sim::World world = world_of("RRRRR");
    grrl_model model = perfect(world);
    for (uint8_t i = 0; i < 4; i++)
        join(model, i, static_cast<uint8_t>(i + 1), GRRL_REVOLUTE);
    std::unique_ptr<Chooser> chooser =
        make_clairvoyant([&world]() -> const grrl_sim::World & { return world; }, 1);
    grrl_perception_config config;
    grrl_perception_config_default(&config);
    auto perception = std::make_unique<grrl_perception>();
    assert_int_equal(grrl_perception_init(perception.get(), &config), GRRL_OK);
    chooser->observe(*perception); /* which has seen nothing: motion alone decides */
    uint64_t before = world.state_hash();
    int number = chooser->choose(model).body_number;
    assert_true(number >= 5); /* the joint between the last two is missing */
    assert_true(world.state_hash() == before);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(the_rule_takes_the_longest_along_its_axis_first),
        cmocka_unit_test(the_rule_has_six_orders),
        cmocka_unit_test(motion_is_expected_where_joints_allow_it),
        cmocka_unit_test(motion_repeats_no_push_in_a_structure),
        cmocka_unit_test(joints_are_known_or_wrong_by_the_truth),
        cmocka_unit_test(joints_between_clusters_of_links_count),
        cmocka_unit_test(the_clairvoyant_goes_for_what_is_not_known),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
