/* Descriptions of objects: what is understood, what is refused and with what words. */
#include "support.hpp"

#include <cmath>
#include <set>

#include "kinematics.hpp"
#include "object_file.hpp"
#include "object_stream.hpp"
#include "placement.hpp"
#include "supervisor.hpp"

using namespace grrl_sim;

namespace
{

const char *const loop_4r = "R(l1, R(l4, R(l3, R(l2, l1))))";
const char *const loop_5r = "R(l1, R(l5, R(l4, R(l3, R(l2, l1)))))";
const char *const slider_crank = "P(l1, R(l4, R(l3, R(l2, l1))))";

void chain_has_links_in_a_row(void **)
{
    ObjectSpec object = must_build("RPRPRPR");
    assert_int_equal(object.links.size(), 8);
    assert_int_equal(object.joints.size(), 7);
    for (size_t j = 0; j < 7; j++) {
        assert_int_equal(object.joints[j].type, j % 2 == 0 ? GRRL_REVOLUTE : GRRL_PRISMATIC);
        assert_int_equal(
            grrl_graph_joint(&object.truth, static_cast<uint8_t>(j), static_cast<uint8_t>(j + 1)),
            object.joints[j].type);
    }
    std::vector<Pose> poses =
        link_poses(object, spanning_forest(object), std::vector<double>(7, 0.0));
    for (size_t i = 0; i < 8; i++) {
        assert_true(std::abs(poses[i].position.y) < 1e-9);
        assert_true(std::abs(poses[i].position.x - 0.13 * static_cast<double>(i)) < 1e-9);
    }
}

void term_and_chain_are_the_same_structure(void **)
{
    Supervisor supervisor(must_build("RRP").truth);
    assert_true(supervisor.judge(must_build("R(l4, R(l3, P(l1, l2)))").truth).correct);
    assert_true(supervisor.judge(must_build("P(l4, R(R(l1, l2), l3))").truth).correct);
    Verdict verdict = supervisor.judge(must_build("RPR").truth);
    assert_false(verdict.correct);
    assert_string_equal(verdict_text(verdict).c_str(),
                        "the right links and joints, joined differently");
    assert_string_equal(verdict_text(supervisor.judge(must_build("RR").truth)).c_str(),
                        "1 link missing, 1 prismatic joint missing");
    assert_string_equal(verdict_text(supervisor.judge(must_build("RPPP").truth)).c_str(),
                        "1 link too many, 1 revolute joint missing, 2 prismatic joints too many");
}

void sizes_set_lengths_but_not_the_verdict(void **)
{
    ObjectSpec object = must_build("R(R(L(l,f1), L(s,f2)), L(l,f3))");
    assert_true(object.links[0].half_length_m > object.links[1].half_length_m);
    assert_int_equal(object.links[1].size, GRRL_PROPERTY_SMALL);
    assert_true(object.links[0].features_max > object.links[1].features_max);
    assert_true(object.links[1].features_min >= 6);
    assert_true(Supervisor(must_build("RR").truth).judge(object.truth).correct);
}

void links_have_any_names(void **)
{
    ObjectSpec named = must_build("D(lb, R(L(l, blade1), L(s, Tip)))");
    assert_string_equal(named.links[0].name.c_str(), "blade1");
    assert_string_equal(named.links[1].name.c_str(), "Tip");
    ObjectSpec numbered = must_build("D(lb, R(L(l, l1), L(s, l2)))");
    assert_true(grrl_graph_equal(&named.truth, &numbered.truth, GRRL_ALL_PROPERTIES));
    assert_int_equal(must_build("L(foo)").links.size(), 1);
    assert_int_equal(must_build("l12").links.size(), 1);
    std::string all = "R(hub_1";
    for (int i = 2; i <= GRRL_MAX_LINKS; i++)
        all += ", arm_" + std::to_string(i);
    assert_int_equal(must_build(all + ")").links.size(), GRRL_MAX_LINKS);
}

void branches_do_not_overlap(void **)
{
    for (const char *text : {"R(l1,l2,l3,l4)", "R(l1,l2,l3,l4,l5,l6,l7,l8,l9)",
                             "R(l1,R(l2,l4,l5),R(l3,l6,l7)) & R(l4,l8,l9)"}) {
        ObjectSpec object = must_build(text);
        for (uint64_t seed = 0; seed < 10; seed++) {
            Random random(seed, Stream::OBJECT);
            assert_false(links_overlap(object, random_poses(object, {2.0, 1.6}, random), 0.0));
        }
    }
}

void loops_close_at_random_configurations(void **)
{
    for (const char *text :
         {loop_4r, loop_5r, slider_crank, "R(l1, P(l4, R(l3, P(l2, l1))))",
          "P(l1, P(l3, P(l2, l1)))", "R(L(s,l1), R(L(l,l4), R(L(s,l3), R(L(s,l2), l1))))"}) {
        ObjectSpec object = must_build(text);
        for (uint64_t seed = 0; seed < 10; seed++) {
            Random random(seed, Stream::OBJECT);
            std::vector<Pose> poses = random_poses(object, {2.0, 1.6}, random);
            for (const JointSpec &joint : object.joints) {
                const Pose &a = poses[static_cast<size_t>(joint.a)];
                const Pose &b = poses[static_cast<size_t>(joint.b)];
                double value = joint_value(joint, a, b);
                Vec2 gap = transform(b, joint.anchor_b_m) - transform(a, joint.anchor_a_m);
                if (joint.type == GRRL_PRISMATIC)
                    gap = gap - value * direction(a.angle + joint.axis_rad);
                assert_true(length(gap) < 1e-5);
                assert_true(value >= joint.lower && value <= joint.upper);
            }
        }
    }
}

void bad_descriptions_say_what_would_be_right(void **)
{
    const std::string too_long(GRRL_MAX_LINKS, 'R');
    struct {
        const char *text;
        const char *part;
    } cases[] = {
        {"RPX", "1:3: a chain cannot contain 'X'; R is a revolute and P a prismatic joint"},
        {"", "the chain is empty"},
        {too_long.c_str(), " (GRRL_MAX_LINKS)"},
        {"R(l1, l2", "1:9: expected"},
        {"foo",
         "'foo' is not a chain such as RPR, not a file such as scissors.grrl, and as a term: "
         "write a single link of this name as L(foo)"},
        {"l1x", "as L(l1x)"},
        {"foo bar", "and as a term: 1:5: expected '&' or the end of the text, found 'bar'"},
        {"R(tip, R(blade, tip))", "link tip is joined twice to blade"},
        {"no-such-file.grrl", "no-such-file.grrl: cannot be read"},
        {"R(l1, R(l2, l1))", "link l1 is joined twice to l2"},
        {"R(l1, R(l3, R(l2, l1)))", "closes but has no mobility: the revolute joint between"},
        {"R(l1, P(l3, R(l2, l1)))", "has no mobility"},
        {"P(l1, P(l4, P(l3, R(l2, l1))))", "a planar loop needs at least 4 joints"},
    };
    for (const auto &c : cases) {
        Result<ObjectSpec> object = object_from_text(c.text);
        assert_false(static_cast<bool>(object));
        assert_contains(object.error, c.part);
    }
}

void terms_over_capacity_are_refused(void **)
{
    std::string deep = "l1";
    for (int i = 2; i < 200; i++)
        deep = "R(l" + std::to_string(i) + ", " + deep + ")";
    assert_false(static_cast<bool>(object_from_text(deep)));
    std::string wide = "R(l1";
    for (int i = 2; i <= GRRL_MAX_LINKS + 1; i++)
        wide += ", l" + std::to_string(i);
    Result<ObjectSpec> object = object_from_text(wide + ")");
    assert_false(static_cast<bool>(object));
    assert_contains(object.error, "1:");
    std::string long_term = "R(l1";
    for (int i = 0; i < 5000; i++)
        long_term += ", l2";
    assert_false(static_cast<bool>(object_from_text(long_term + ")")));
}

void shipped_files_are_objects(void **)
{
    const std::string folder = GRRL_OBJECTS;
    ObjectSpec scissors = must_build(folder + "/scissors.grrl");
    assert_int_equal(scissors.links.size(), 2);
    assert_string_equal(scissors.links[1].name.c_str(), "blade2");
    assert_true(std::abs(scissors.links[0].half_length_m - 0.10) < 1e-12);
    assert_true(std::abs(scissors.joints[0].upper - radians(75.0)) < 1e-12);
    assert_true(std::abs(scissors.joints[0].anchor_a_m.x + 0.01) < 1e-12);
    ObjectSpec toy = must_build(folder + "/wooden-toy.grrl");
    assert_true(Supervisor(must_build("PRR").truth).judge(toy.truth).correct);
    ObjectSpec shears = must_build(folder + "/garden-shears.grrl");
    assert_int_equal(shears.joints.size(), 1);
    assert_int_equal(shears.links[1].size, GRRL_PROPERTY_LARGE);
    assert_true(std::abs(shears.links[1].half_length_m - 0.15) < 1e-12);
}

void bad_files_are_told_by_line_and_column(void **)
{
    struct {
        const char *text;
        const char *part;
    } cases[] = {
        {"# nothing\n", "f:1:1: the file has no term"},
        {"term R(l1, \n", "f:1:"},
        {"  term R(l1, l1)\n", "f:1:"},
        {"link l1 0.1 0.1 0.1\n", "f:1:1: the term must come before"},
        {"term R(l1, l2)\nterm R(l1, l2)\n", "f:2:1: a second term"},
        {"term R(l1, l2)\n link l3 0.1 0.1 0.1\n",
         "f:2:7: the term has no link 'l3'; it has l1, l2"},
        {"term R(blade1, L(s, Tip))\n link tip 0.1 0.1 0.1\n",
         "f:2:7: the term has no link 'tip'; it has blade1, Tip"},
        {"term R(blade1, blade-2)\n", "f:1:21: expected ',', ')' or '&'"},
        {"term R(l1, l2)\nlink l1 0.1 x 0.1\n", "f:2:13: the width 'x' must be a number from"},
        {"term R(l1, l2)\nlink l1 nan 0.1 0.1\n", "f:2:9: the length 'nan' must be a number"},
        {"term R(l1, l2)\nlink l1 0.1 0.1\n", "f:2:16: expected: link NAME"},
        {"term R(l1, l2)\nlink l1 0.1 0.1 0.1 7\n", "f:2:21: expected: link NAME"},
        {"term R(l1, l2)\nhinge l1 l2\n", "f:2:1: unknown statement 'hinge'; expected"},
        {"term R(l1, l2, l3)\njoint l2 l3 0 1 0 0 0 0 0\n", "f:2:7: the term has no joint between"},
        {"term R(l1, l2)\njoint l1 l2 5 1 0 0 0 0 0\n", "f:2:15: the upper limit must be above"},
        {"term R(l1, R(l4, R(l3, R(l2, l1))))\nlink l1 0.9 0.03 0.1\n",
         "f:1:1: the loop through l1, l4, l3, l2 cannot close: its links do not reach"},
    };
    for (const auto &c : cases) {
        Result<ObjectSpec> object = object_from_file_text(c.text, "f");
        assert_false(static_cast<bool>(object));
        assert_contains(object.error, c.part);
    }
}

void scaled_objects_move_like_their_larger_twins(void **)
{
    ObjectScale half;
    half.length = 0.5;
    half.similar = true;
    ObjectSpec twin = *object_from_text("RP").value;
    ObjectSpec object = *object_from_text("RP", half).value;
    assert_true(std::abs(object.links[0].half_length_m - 0.5 * twin.links[0].half_length_m) <
                1e-12);
    assert_true(std::abs(object.links[0].mass_kg - 0.5 * twin.links[0].mass_kg) < 1e-12);
    assert_true(std::abs(object.joints[0].friction - 0.25 * twin.joints[0].friction) < 1e-12);
    assert_true(std::abs(object.joints[1].friction - 0.5 * twin.joints[1].friction) < 1e-12);
    assert_true(std::abs(object.joints[0].upper - twin.joints[0].upper) < 1e-12); /* an angle */
    assert_true(std::abs(object.joints[1].upper - 0.5 * twin.joints[1].upper) < 1e-12);
    half.similar = false;
    object = *object_from_text("RP", half).value;
    assert_true(object.joints[0].friction == twin.joints[0].friction);
    assert_contains(object_from_text(std::string(GRRL_OBJECTS) + "/scissors.grrl", half).error,
                    "cannot follow links of another length");
    ObjectScale rich;
    rich.features = 2.0;
    rich.friction = 3.0;
    object = *object_from_text("RP", rich).value;
    assert_int_equal(object.links[1].features_max, 2 * twin.links[1].features_max);
    assert_true(object.joints[1].friction == 3.0 * twin.joints[1].friction);
}

void a_stream_draws_what_it_says(void **)
{
    ObjectStream stream = *stream_from_text("links 3..5, 8\nrevolute 1\nbranches 0.5\n"
                                            "objects 1, 2\nloops 0.3 # some\nsize 0.5, 1\n"
                                            "length 0.9..1.1\n",
                                            "f")
                               .value;
    int loops = 0;
    int pairs = 0;
    int small = 0;
    std::set<std::string> terms;
    for (uint64_t seed = 0; seed < 200; seed++) {
        ObjectSpec object = stream.sample(seed);
        size_t links = object.links.size();
        size_t trees = links - spanning_forest(object).tree.size();
        assert_in_range(links, 3, 16);
        assert_true(trees == 1 || trees == 2);
        assert_int_equal(object.truth.n, links);
        for (const JointSpec &joint : object.joints)
            assert_int_equal(joint.type, GRRL_REVOLUTE);
        double length = object.links[0].half_length_m / LinkSpec{}.half_length_m;
        assert_true((length > 0.44 && length < 0.56) || (length > 0.89 && length < 1.11) ||
                    object.joints.size() > 2); /* a hub makes room for its branches */
        loops += object.joints.size() > links - trees ? 1 : 0;
        pairs += trees == 2 ? 1 : 0;
        small += length < 0.56 ? 1 : 0;
        std::string term = term_of(object);
        Result<ObjectSpec> again = object_from_term(term);
        assert_true(static_cast<bool>(again));
        assert_true(Supervisor(object.truth).judge(again.value->truth).correct);
        assert_string_equal(term_of(stream.sample(seed)).c_str(), term.c_str());
        terms.insert(term);
    }
    assert_in_range(loops, 20, 120);
    assert_in_range(pairs, 70, 130);
    assert_in_range(small, 60, 130);
    assert_true(terms.size() > 50);
}

void bad_streams_are_told_by_line_and_column(void **)
{
    const struct {
        const char *text;
        const char *part;
    } cases[] = {
        {"link 3\n", "f:1:1: unknown statement 'link'; expected one of links, objects, revolute"},
        {"\nlinks 3..x\n", "f:2:10: 'x' must be a whole number from 2 to 10, or a range"},
        {"links 2.5\n", "f:1:7: '2.5' must be a whole number"},
        {"links 3,\n", "f:1:9: '' must be a whole number"},
        {"links\n", "f:1:6: '' must be a whole number"},
        {"size nan\n", "f:1:6: 'nan' must be a number from 0.4 to 2"},
        {"size 1, 1.2..0.8\n", "a range starts with its lower end"},
        {"size 1\n  size 1\n", "f:2:3: a second 'size'; separate several values by commas"},
        {"links 9\nobjects 1, 2\n", "f: up to 18 links on the table; this build holds at most 16"},
    };
    for (const auto &c : cases) {
        Result<ObjectStream> stream = stream_from_text(c.text, "f");
        assert_false(static_cast<bool>(stream));
        assert_contains(stream.error, c.part);
    }
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(chain_has_links_in_a_row),
        cmocka_unit_test(term_and_chain_are_the_same_structure),
        cmocka_unit_test(sizes_set_lengths_but_not_the_verdict),
        cmocka_unit_test(links_have_any_names),
        cmocka_unit_test(branches_do_not_overlap),
        cmocka_unit_test(loops_close_at_random_configurations),
        cmocka_unit_test(bad_descriptions_say_what_would_be_right),
        cmocka_unit_test(terms_over_capacity_are_refused),
        cmocka_unit_test(shipped_files_are_objects),
        cmocka_unit_test(bad_files_are_told_by_line_and_column),
        cmocka_unit_test(scaled_objects_move_like_their_larger_twins),
        cmocka_unit_test(a_stream_draws_what_it_says),
        cmocka_unit_test(bad_streams_are_told_by_line_and_column),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
