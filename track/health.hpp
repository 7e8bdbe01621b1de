/*
 * health.hpp: problems with the images: darkness, overexposure, blur, a slow camera, too few
 * points, a lost scene. Each is reported once, with a remedy.
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

    /* Images per second, as reported or as measured. */
    void check_rate(double rate);

    /* The arrival time of a live image, by any clock. */
    void arrived(int64_t now_us);

    void check_picture(const cv::Mat &picture);
    void check_points(const std::vector<Point> &points);

private:
    void once(const char *what, const std::string &text);

    std::function<void(const std::string &)> tell_;
    std::set<std::string> told_;
    int64_t first_us_ = 0;
    int64_t pictures_ = 0;
    size_t visible_ = 0; /* in the last image */
    bool checked_ = false;
};

/* Blur from 0 (sharp) to 1: the share of the steepest slopes that remains after additional blur. */
double blur_of(const cv::Mat &picture);

} // namespace grrl_track

#endif
