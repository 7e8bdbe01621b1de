/* The baseline and the judge, on worlds without noise; the cut on graphs known by hand. */

#include <csetjmp>
#include <cstdarg>
#include <cstddef>
#include <cstdint>

extern "C" {
#include <cmocka.h>
}

#include "perception/baseline.hpp"
#include "perception/sparse_cut.hpp"
#include "perception/verdict.hpp"

using namespace grrl_experiment;
using namespace grrl_experiment::perception;
using grrl_sim::Frame;
using grrl_sim::Vec2;
using grrl_sim::World;

namespace
{

void test_sparse_cut(void **)
{
    /* two cliques of five, tied by two edges */
    std::vector<std::vector<int>> edges(10, std::vector<int>(10, 0));
    for (size_t i = 0; i < 10; i++)
        for (size_t j = 0; j < 10; j++)
            edges[i][j] = i != j && i % 2 == j % 2;
    edges[0][1] = edges[1][0] = edges[2][3] = edges[3][2] = 1;
    SparseCut cut = sparse_cut(edges, 4);
    assert_true(cut.density > 0.079 && cut.density < 0.081);
    assert_int_equal(cut.apart.size(), 5);
    for (size_t v : cut.apart)
        assert_int_equal(v % 2, cut.apart[0] % 2);
    assert_true(sparse_cut(edges, 6).density > 1.0); /* no side may have fewer than six */
}

std::vector<Frame> look(World &world)
{
    std::vector<Frame> frames(3);
    for (Frame &frame : frames) {
        (void)world.step_frame();
        world.observe(frame);
    }
    return frames;
}

/* A hinge pushed at the outer ends of its links, so that it folds, and seen without noise: two
 * bodies and a pivot. */
void test_hinge(void **)
{
    grrl_sim::WorldParams params;
    params.tracker.noise_sigma_m = 0.0;
    World world(*grrl_sim::object_from_text("D(lb, R(l1, l2))").value, params, 3);
    Baseline baseline(world.tracker().feature_count());
    baseline.rest(look(world));
    Estimate nothing = baseline.estimate();
    assert_int_equal(nothing.links, 0);
    Verdict verdict = judge(nothing, world);
    assert_true(verdict.missed_joint && !verdict.wrong_joint && !verdict.exact);
    for (int i = 0; i < 12; i++) {
        grrl_sim::Pose link = world.true_poses()[static_cast<size_t>(i % 2)];
        double end = i % 2 == 0 ? 0.05 : -0.05;
        grrl_sim::PushCommand command;
        command.start_m = transform(link, Vec2{end, 0.08});
        command.end_m = transform(link, Vec2{end, -0.08});
        if (world.begin_push(command).empty())
            while (world.step_frame()) {
            }
        baseline.rest(look(world));
    }
    assert_true(world.true_joint_range(0) > grrl_sim::radians(10.0));
    Estimate estimate = baseline.estimate();
    assert_int_equal(estimate.joints.size(), 1);
    assert_int_equal(estimate.joints[0].type, GRRL_REVOLUTE);
    verdict = judge(estimate, world);
    assert_true(verdict.exact && !verdict.wrong_joint && !verdict.missed_joint);
    assert_int_equal(verdict.sure_and_right, 1);

    estimate.joints[0].type = GRRL_PRISMATIC;
    verdict = judge(estimate, world);
    assert_true(verdict.wrong_joint && verdict.missed_joint && !verdict.exact);
    assert_int_equal(verdict.sure, 1);
    assert_int_equal(verdict.sure_and_right, 0);
    estimate.features[0].second = estimate.links++; /* one feature torn off */
    assert_true(judge(estimate, world).false_split);
}

} // namespace

int main()
{
    const CMUnitTest tests[] = {cmocka_unit_test(test_sparse_cut), cmocka_unit_test(test_hinge)};
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
