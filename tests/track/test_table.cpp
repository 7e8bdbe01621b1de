/* From pixels to metres: scales, slanted cameras, bent lenses, checkerboards. */
#include <csetjmp>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <unistd.h>

#include <opencv2/imgproc.hpp>

#include "table.hpp"

extern "C" {
#include <cmocka.h>
}

using namespace grrl_track;

static const cv::Size size(640, 480);

static void assert_near(cv::Point2d a, cv::Point2d b, double within)
{
    if (cv::norm(a - b) > within)
        std::printf("(%g, %g) is not (%g, %g)\n", a.x, a.y, b.x, b.y);
    assert_true(cv::norm(a - b) <= within);
}

static void a_scale_puts_the_origin_in_the_middle(void **)
{
    Table table;
    assert_near(table.to_m({12.0, 34.0}), {12.0, 34.0}, 0.0); /* unknown: pixels */
    table.set_scale(size, 1.56, 0.0);
    assert_near(table.to_m({319.5, 239.5}), {0.0, 0.0}, 1e-12);
    assert_near(table.to_m({329.5, 219.5}), {0.0156, 0.0312}, 1e-12);
    assert_near(table.to_px({0.0156, 0.0312}), {329.5, 219.5}, 1e-9);
}

static void there_and_back_is_where_it_was(void **)
{
    for (double distortion : {-0.2, -0.05, 0.0, 0.1, 0.2}) {
        Table table;
        table.set_scale(size, 2.0, distortion);
        for (int y = 0; y < size.height; y += 37)
            for (int x = 0; x < size.width; x += 41) {
                cv::Point2d px(x, y);
                assert_near(table.to_px(table.to_m(px)), px, 1e-3);
            }
    }
}

/* Of a camera that looks at a slant. */
static cv::Point2d slanted(cv::Point2d m)
{
    double w = 1.0 + 0.3 * m.y + 0.1 * m.x;
    return {320.0 + 500.0 * m.x / w, 250.0 - 480.0 * m.y / w};
}

static std::vector<PointPair> rectangle()
{
    std::vector<PointPair> pairs;
    for (cv::Point2d m : {cv::Point2d(-0.4, 0.3), cv::Point2d(0.4, 0.3), cv::Point2d(0.4, -0.3),
                          cv::Point2d(-0.4, -0.3)})
        pairs.push_back({slanted(m), m});
    return pairs;
}

static void four_points_make_a_slanted_table(void **)
{
    Table table;
    assert_string_equal(table.set_points(size, rectangle(), 0.0).c_str(), "");
    for (double x = -0.5; x <= 0.5; x += 0.1)
        for (double y = -0.4; y <= 0.4; y += 0.1) {
            assert_near(table.to_m(slanted({x, y})), {x, y}, 1e-6);
            assert_near(table.to_px({x, y}), slanted({x, y}), 1e-3);
        }
}

static void bad_points_are_refused(void **)
{
    Table table;
    std::vector<PointPair> pairs = rectangle();
    pairs.pop_back();
    assert_non_null(std::strstr(table.set_points(size, pairs, 0.0).c_str(), "four points"));
    pairs = rectangle();
    pairs[2].px = 0.5 * (pairs[0].px + pairs[1].px);
    assert_non_null(std::strstr(table.set_points(size, pairs, 0.0).c_str(), "on a line"));
    pairs = rectangle();
    pairs.push_back({slanted({0.0, 0.0}) + cv::Point2d(60.0, 0.0), {0.0, 0.0}});
    assert_non_null(std::strstr(table.set_points(size, pairs, 0.0).c_str(), "mistyped"));
    assert_false(table.known());
}

static void points_are_parsed(void **)
{
    std::vector<PointPair> pairs;
    assert_string_equal(
        parse_points("12,30=-0.4,0.3 628,30=.4,.3 12,450=-.4,-.3 628.5,450=.4,-.3", pairs).c_str(),
        "");
    assert_int_equal(pairs.size(), 4);
    assert_true(pairs[3].px.x == 628.5 && pairs[3].m.y == -0.3);
    for (const char *bad : {"12,30=-0.4 1,1=1,1", "12,30=-0.4,0.3x", "a", "nan,1=1,1", ""})
        assert_false(parse_points(bad, pairs).empty());
    Board board;
    assert_string_equal(parse_board("9x6x25", board).c_str(), "");
    assert_true(board.columns == 9 && board.rows == 6 && board.square_m == 0.025);
    for (const char *bad : {"9x6", "2x6x25", "9x6x0", "9x6x25x", "x", "9x6xnan"})
        assert_false(parse_board(bad, board).empty());
}

/* Where a pixel of a slanted camera with a bent lens looks: the inverse of slanted, distorted. */
static cv::Point2d looks_at(cv::Point2d px, double distortion)
{
    cv::Point2d centre(319.5, 239.5);
    cv::Point2d out = px - centre;
    cv::Point2d s = centre + out * (1.0 / (1.0 + distortion * out.dot(out) / (320.0 * 320.0)));
    /* u w = 500 x, v w = 480 y, w = 1 + 0.3 y + 0.1 x */
    double u = (s.x - 320.0) / 500.0;
    double v = (250.0 - s.y) / 480.0;
    double w = 1.0 / (1.0 - 0.1 * u - 0.3 * v);
    return {u * w, v * w};
}

/* Six by five squares of 80 mm in black and white, its first inner corner at (-0.2, 0.16). */
static cv::Mat board_picture(double distortion)
{
    cv::Mat picture(size, CV_8UC1);
    for (int row = 0; row < size.height; row++)
        for (int column = 0; column < size.width; column++) {
            double sum = 0.0;
            for (int k = 0; k < 16; k++) {
                cv::Point2d m = looks_at({column - 0.375 + 0.25 * (k % 4),
                                          row - 0.375 + 0.25 * (k / 4)}, // 4 x 4 samples a pixel
                                         distortion);
                int i = static_cast<int>(std::floor((m.x + 0.28) / 0.08));
                int j = static_cast<int>(std::floor((0.24 - m.y) / 0.08));
                bool on = i >= 0 && i < 7 && j >= 0 && j < 6;
                sum += on && (i + j) % 2 == 0 ? 30.0 : 220.0;
            }
            picture.at<uchar>(row, column) = static_cast<uchar>(sum / 16.0);
        }
    return picture;
}

/* The board may be found from either of its ends: compare distances, which do not change. */
static void a_checkerboard_calibrates(void **)
{
    Board board;
    assert_string_equal(parse_board("6x5x80", board).c_str(), "");
    for (double distortion : {0.0, -0.08, 0.05}) {
        Table table;
        double error_px = 0.0;
        std::string problem = table.calibrate(board_picture(distortion), board, error_px);
        assert_string_equal(problem.c_str(), "");
        std::printf("distortion %.2f: corners within %.3f px\n", distortion, error_px);
        assert_true(error_px < 0.2);
        for (cv::Point2d a : {cv::Point2d(230, 180), cv::Point2d(320, 240), cv::Point2d(430, 300)})
            for (cv::Point2d b : {cv::Point2d(240, 310), cv::Point2d(400, 190)}) {
                double truth = cv::norm(looks_at(a, distortion) - looks_at(b, distortion));
                double seen = cv::norm(table.to_m(a) - table.to_m(b));
                assert_true(std::abs(seen - truth) < 0.001);
            }
    }
    Table table;
    double error_px = 0.0;
    assert_false(table.calibrate(cv::Mat(size, CV_8UC1, cv::Scalar(90)), board, error_px).empty());
    assert_false(table.known());
}

static void a_calibration_is_kept(void **)
{
    char path[] = "/tmp/grrl_calibration_XXXXXX";
    int file = mkstemp(path);
    assert_true(file >= 0);
    Table table;
    assert_string_equal(table.set_points(size, rectangle(), 0.03).c_str(), "");
    assert_string_equal(table.save(path).c_str(), "");
    Table again;
    assert_string_equal(again.load(path, size).c_str(), "");
    assert_near(again.to_m({100.0, 50.0}), table.to_m({100.0, 50.0}), 1e-12);
    Table other;
    assert_non_null(std::strstr(other.load(path, {320, 240}).c_str(), "320 x 240"));
    assert_int_equal(ftruncate(file, 60), 0);
    assert_non_null(std::strstr(other.load(path, size).c_str(), "not a calibration"));
    assert_false(other.known());
    (void)close(file);
    (void)unlink(path);
    assert_non_null(std::strstr(other.load(path, size).c_str(), "No such file"));
}

int main()
{
    const CMUnitTest tests[] = {
        cmocka_unit_test(a_scale_puts_the_origin_in_the_middle),
        cmocka_unit_test(there_and_back_is_where_it_was),
        cmocka_unit_test(four_points_make_a_slanted_table),
        cmocka_unit_test(bad_points_are_refused),
        cmocka_unit_test(points_are_parsed),
        cmocka_unit_test(a_checkerboard_calibrates),
        cmocka_unit_test(a_calibration_is_kept),
    };
    return cmocka_run_group_tests(tests, nullptr, nullptr);
}
