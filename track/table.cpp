/* Fits homography and lens distortion, finds checkerboards, loads and saves calibrations. */
#include "table.hpp"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

namespace grrl_track
{

namespace
{

constexpr double least_board_error_px = 1.0;
constexpr double distortion_range = 0.25;
constexpr int distortion_steps = 40; /* of a golden section */
constexpr double degenerate = 0.02;  /* height of a triangle divided by its longest side */

cv::Point2d apply(const cv::Matx33d &h, cv::Point2d point)
{
    cv::Vec3d v = h * cv::Vec3d(point.x, point.y, 1.0);
    return {v[0] / v[2], v[1] / v[2]};
}

/* Whether the three points are nearly on a line, or two of them coincide. */
bool thin(cv::Point2d a, cv::Point2d b, cv::Point2d c)
{
    double longest = std::max({cv::norm(a - b), cv::norm(b - c), cv::norm(c - a)});
    return longest <= 0.0 || std::abs((b - a).cross(c - a)) < degenerate * longest * longest;
}

} // namespace

cv::Point2d Table::straighten(cv::Point2d px) const
{
    cv::Point2d centre(0.5 * (picture_.width - 1), 0.5 * (picture_.height - 1));
    cv::Point2d out = px - centre;
    double half = 0.5 * picture_.width;
    return centre + out * (1.0 / (1.0 + distortion_ * out.dot(out) / (half * half)));
}

cv::Point2d Table::bend(cv::Point2d straight) const
{
    cv::Point2d centre(0.5 * (picture_.width - 1), 0.5 * (picture_.height - 1));
    cv::Point2d out = straight - centre;
    double half = 0.5 * picture_.width;
    double root = 1.0 - 4.0 * distortion_ * out.dot(out) / (half * half);
    return centre + out * (2.0 / (1.0 + std::sqrt(std::max(0.0, root))));
}

cv::Point2d Table::to_m(cv::Point2d px) const
{
    return known_ ? apply(to_table_, straighten(px)) : px;
}

cv::Point2d Table::to_px(cv::Point2d m) const
{
    return known_ ? bend(apply(to_picture_, m)) : m;
}

void Table::set_scale(cv::Size picture, double mm_per_px, double distortion)
{
    double s = 0.001 * mm_per_px;
    picture_ = picture;
    distortion_ = distortion;
    to_table_ = cv::Matx33d(s, 0.0, -0.5 * s * (picture.width - 1), 0.0, -s,
                            0.5 * s * (picture.height - 1), 0.0, 0.0, 1.0);
    to_picture_ = to_table_.inv();
    known_ = true;
}

/* Fits the best homography for this distortion; returns the root mean square residual in pixels. */
double Table::fit(const std::vector<PointPair> &pairs, double distortion)
{
    std::vector<cv::Point2d> straight;
    std::vector<cv::Point2d> metres;
    distortion_ = distortion;
    for (const PointPair &pair : pairs) {
        straight.push_back(straighten(pair.px));
        metres.push_back(pair.m);
    }
    cv::Mat h = cv::findHomography(straight, metres, 0);
    if (h.empty())
        return HUGE_VAL;
    to_table_ = cv::Matx33d(h.ptr<double>());
    if (std::abs(cv::determinant(to_table_)) < 1e-15)
        return HUGE_VAL;
    to_picture_ = to_table_.inv();
    known_ = true;
    double sum = 0.0;
    for (const PointPair &pair : pairs) {
        cv::Point2d off = to_px(pair.m) - pair.px;
        sum += off.dot(off);
    }
    return std::sqrt(sum / static_cast<double>(pairs.size()));
}

std::string Table::set_points(cv::Size picture, const std::vector<PointPair> &pairs,
                              double distortion)
{
    if (pairs.size() < 4)
        return "four points are needed; there are " + std::to_string(pairs.size());
    for (size_t i = 0; i < 4; i++)
        for (size_t j = i + 1; j < 4; j++)
            for (size_t k = j + 1; k < 4; k++)
                if (thin(pairs[i].px, pairs[j].px, pairs[k].px) ||
                    thin(pairs[i].m, pairs[j].m, pairs[k].m))
                    return "points " + std::to_string(i + 1) + ", " + std::to_string(j + 1) +
                           " and " + std::to_string(k + 1) +
                           " are on a line; no three of the first four may be: use the corners of "
                           "a rectangle";
    Table table;
    table.picture_ = picture;
    double error_px = table.fit(pairs, distortion);
    if (!(error_px < 5.0)) {
        char text[120];
        (void)std::snprintf(
            text, sizeof text,
            "the points do not fit a plane; they are off by %.1f pixels; is one of them mistyped?",
            error_px);
        return text;
    }
    *this = table;
    return {};
}

std::string Table::calibrate(const cv::Mat &picture, const Board &board, double &error_px)
{
    cv::Mat grey;
    if (picture.channels() == 3)
        cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    else
        grey = picture;
    std::vector<cv::Point2f> corners;
    if (!cv::findChessboardCorners(grey, {board.columns, board.rows}, corners,
                                   cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE))
        return "no checkerboard with " + std::to_string(board.columns) + " x " +
               std::to_string(board.rows) +
               " inner corners is visible; all of it must be in the image, flat, sharp, evenly lit "
               "and with a white border";
    cv::cornerSubPix(grey, corners, {5, 5}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 40, 0.001});
    std::vector<PointPair> pairs;
    for (size_t i = 0; i < corners.size(); i++)
        pairs.push_back(
            {corners[i],
             {board.square_m * static_cast<double>(i % static_cast<size_t>(board.columns)),
              -board.square_m * static_cast<double>(i / static_cast<size_t>(board.columns))}});
    Table table;
    table.picture_ = picture.size();
    const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
    double low = -distortion_range;
    double high = distortion_range;
    for (int i = 0; i < distortion_steps; i++) {
        double a = high - golden * (high - low);
        double b = low + golden * (high - low);
        (table.fit(pairs, a) < table.fit(pairs, b) ? high : low) =
            table.fit(pairs, a) < table.fit(pairs, b) ? b : a;
    }
    error_px = table.fit(pairs, 0.5 * (low + high));
    if (!(error_px < least_board_error_px)) {
        char text[120];
        (void)std::snprintf(
            text, sizeof text,
            "the checkerboard's corners are off by %.1f pixels; is it flat, and are "
            "the numbers right?",
            error_px);
        return text;
    }
    *this = table;
    return {};
}

std::string Table::save(const std::string &path) const
{
    std::ofstream file(path);
    file.precision(17);
    file << "grrl-track calibration 1\n"
         << picture_.width << " " << picture_.height << "\n"
         << distortion_ << "\n";
    for (int row = 0; row < 3; row++)
        file << to_table_(row, 0) << " " << to_table_(row, 1) << " " << to_table_(row, 2) << "\n";
    file.close();
    return file ? std::string() : path + ": " + std::strerror(errno);
}

std::string Table::load(const std::string &path, cv::Size picture)
{
    std::ifstream file(path);
    if (!file)
        return path + ": " + std::strerror(errno);
    std::string head;
    Table table;
    std::getline(file, head);
    file >> table.picture_.width >> table.picture_.height >> table.distortion_;
    for (double &value : table.to_table_.val)
        file >> value;
    bool good = file && head == "grrl-track calibration 1" && std::abs(table.distortion_) < 1.0 &&
                std::abs(cv::determinant(table.to_table_)) > 1e-15;
    if (!good)
        return path + ": not a calibration; create one with grrl-track --calibrate";
    if (table.picture_ != picture)
        return path + ": it is for images of " + std::to_string(table.picture_.width) + " x " +
               std::to_string(table.picture_.height) + ", these are " +
               std::to_string(picture.width) + " x " + std::to_string(picture.height) +
               "; calibrate again at this size";
    table.to_picture_ = table.to_table_.inv();
    table.known_ = true;
    *this = table;
    return {};
}

std::string parse_points(const std::string &text, std::vector<PointPair> &pairs)
{
    std::istringstream items(text);
    std::string item;
    pairs.clear();
    while (items >> item) {
        PointPair pair;
        int end = 0;
        if (std::sscanf(item.c_str(), "%lf,%lf=%lf,%lf%n", &pair.px.x, &pair.px.y, &pair.m.x,
                        &pair.m.y, &end) != 4 ||
            static_cast<size_t>(end) != item.size() || !std::isfinite(pair.px.x) ||
            !std::isfinite(pair.px.y) || !std::isfinite(pair.m.x) || !std::isfinite(pair.m.y))
            return "PX,PY=X,Y for each point, a pixel and its place in metres, as in "
                   "12,30=-0.4,0.3; not " +
                   item;
        pairs.push_back(pair);
    }
    if (pairs.size() < 4)
        return "at least four points, not " + std::to_string(pairs.size()) +
               "; as in \"12,30=-0.4,0.3 628,30=0.4,0.3 12,450=-0.4,-0.3 628,450=0.4,-0.3\"";
    return {};
}

std::string parse_board(const std::string &text, Board &board)
{
    double mm = 0.0;
    int end = 0;
    if (std::sscanf(text.c_str(), "%dx%dx%lf%n", &board.columns, &board.rows, &mm, &end) != 3 ||
        static_cast<size_t>(end) != text.size() || board.columns < 3 || board.rows < 3 ||
        board.columns > 50 || board.rows > 50 || !(mm >= 1.0 && mm <= 1000.0))
        return "COLUMNSxROWSxMM: inner corners, 3 to 50, and the side of a "
               "square, as in 9x6x25";
    board.square_m = 0.001 * mm;
    return {};
}

} // namespace grrl_track
