/*
 * table.hpp: from pixels to metres on the table.
 *
 * A camera that looks straight or at a slant onto a plane is a homography. A lens with distortion k
 * moves points along the ray from the picture's centre: one seen at r, in halves of the picture's
 * width, should be at r / (1 + k r^2) (Fitzgibbon's division model). Both come from a scale, from
 * points whose place is known, or from a picture of a checkerboard.
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
    /* Whether there is a way to metres; else to_m gives pixels. */
    bool known() const { return known_; }

    cv::Point2d to_m(cv::Point2d px) const;
    cv::Point2d to_px(cv::Point2d m) const;

    /* Straight above: the origin lies in the middle, y points up. */
    void set_scale(cv::Size picture, double mm_per_px, double distortion);

    /* The functions below return what is wrong, or an empty text, and change nothing then. */

    /* At least four points, no three of them on a line; with a given distortion. */
    std::string set_points(cv::Size picture, const std::vector<PointPair> &pairs,
                           double distortion);

    /* Finds the board and fits homography and distortion; the origin is its first corner, x along
     * its columns. error_px: of its corners, root mean square. */
    std::string calibrate(const cv::Mat &picture, const Board &board, double &error_px);

    std::string save(const std::string &path) const;
    std::string load(const std::string &path, cv::Size picture);

private:
    cv::Point2d straighten(cv::Point2d px) const; /* takes the distortion out, .. */
    cv::Point2d bend(cv::Point2d straight) const; /* .. and brings it in */
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
