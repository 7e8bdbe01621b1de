/*
 * health.hpp: what may be wrong with the pictures: darkness, glare, blur, a slow camera, too few
 * points, a lost scene. Each is told once, with what to do.
 */
#ifndef GRRL_TRACK_HEALTH_HPP
#define GRRL_TRACK_HEALTH_HPP

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "eye.hpp"

namespace grrl_track
{

class Health
{
public:
    explicit Health(std::function<void(const std::string &)> tell) : tell_(std::move(tell)) {}

    /* Pictures a second, as told or as measured. */
    void check_rate(double rate);

    /* A live picture's arrival, by any clock. */
    void arrived(int64_t now_us);

    void check_picture(const cv::Mat &picture);
    void check_points(const std::vector<Point> &points);

private:
    void once(const char *what, const std::string &text);

    std::function<void(const std::string &)> tell_;
    std::set<std::string> told_;
    int64_t first_us_ = 0;
    int64_t pictures_ = 0;
    size_t visible_ = 0; /* in the last picture */
    bool checked_ = false;
};

/* Between 0, sharp, and 1: how much of the steepest slopes is left after some more blur. */
double blur_of(const cv::Mat &picture);

} // namespace grrl_track

#endif
