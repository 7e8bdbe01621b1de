/*
 * table.hpp: from pixels to metres on the table.
 *
 * A camera looking at a plane, straight or at a slant, is described by a homography. A lens with
 * distortion k moves points along the ray from the image centre: a point seen at r, in units of
 * half the image width, should be at r / (1 + k r^2) (Fitzgibbon's division model). Both are
 * determined by a scale, by points with known positions, or by an image of a checkerboard.
 */
#ifndef GRRL_TRACK_TABLE_HPP
#define GRRL_TRACK_TABLE_HPP

#include <string>
#include <vector>

#include <opencv2/core.hpp>

namespace grrl_track
{

struct PointPair {
    cv::Point2d px;
    cv::Point2d m;
};

struct Board {
    int columns = 0; /* inner corners */
    int rows = 0;
    double square_m = 0.0;
};

class Table
{
public:
    /* Whether metres are known; otherwise to_m returns pixels. */
    bool known() const { return known_; }

    cv::Point2d to_m(cv::Point2d px) const;
    cv::Point2d to_px(cv::Point2d m) const;

    /* A camera straight above: the origin is in the middle, y points up. */
    void set_scale(cv::Size picture, double mm_per_px, double distortion);

    /* The functions below return an empty text, or an error message, in which case they change
     * nothing. */

    /* From at least four points, no three of them on a line, with a given distortion. */
    std::string set_points(cv::Size picture, const std::vector<PointPair> &pairs,
                           double distortion);

    /* Finds the board and fits homography and distortion; the origin is its first corner, x along
     * its columns. error_px: root mean square error of the corners. */
    std::string calibrate(const cv::Mat &picture, const Board &board, double &error_px);

    std::string save(const std::string &path) const;
    std::string load(const std::string &path, cv::Size picture);

private:
    cv::Point2d straighten(cv::Point2d px) const; /* removes the distortion, ... */
    cv::Point2d bend(cv::Point2d straight) const; /* ... and adds it */
    double fit(const std::vector<PointPair> &pairs, double distortion);

    bool known_ = false;
    cv::Size picture_;
    double distortion_ = 0.0;
    cv::Matx33d to_table_ = cv::Matx33d::eye();
    cv::Matx33d to_picture_ = cv::Matx33d::eye();
};

/* "PX,PY=X,Y ..", or "COLUMNSxROWSxMM"; returns an empty text, or what it must be. */
std::string parse_points(const std::string &text, std::vector<PointPair> &pairs);
std::string parse_board(const std::string &text, Board &board);

} // namespace grrl_track

#endif
