/* Measures of light, blur and rate, and the warnings they lead to. */
#include "health.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <opencv2/imgproc.hpp>

namespace grrl_track
{

namespace
{

constexpr double least_rate = 8.0;
constexpr int64_t rate_window_us = 3000000;
constexpr double dark_grey = 25.0;
constexpr double bright_grey = 235.0;
constexpr double max_blur = 0.8;
constexpr double quantile = 0.995; /* of the slopes */
constexpr size_t few_points = 12;

double steepest(const cv::Mat &grey)
{
    cv::Mat x;
    cv::Mat y;
    cv::Mat slope;
    cv::Sobel(grey, x, CV_32F, 1, 0);
    cv::Sobel(grey, y, CV_32F, 0, 1);
    cv::magnitude(x, y, slope);
    std::vector<float> values(slope.begin<float>(), slope.end<float>());
    auto at = values.begin() +
              static_cast<std::ptrdiff_t>(quantile * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return static_cast<double>(*at);
}

cv::Mat grey_of(const cv::Mat &picture)
{
    cv::Mat grey;
    if (picture.channels() == 3)
        cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    else
        grey = picture;
    return grey;
}

std::string with(const char *format, double value)
{
    char text[300];
    (void)std::snprintf(text, sizeof text, format, value);
    return text;
}

} // namespace

double blur_of(const cv::Mat &picture)
{
    cv::Mat once;
    cv::Mat twice;
    cv::GaussianBlur(grey_of(picture), once, cv::Size(),
                     1.0); /* noise must not count as sharpness */
    cv::GaussianBlur(once, twice, cv::Size(), 2.0);
    double slope = steepest(once);
    return slope > 0.0 ? steepest(twice) / slope : 1.0;
}

void Health::once(const char *what, const std::string &text)
{
    if (told_.insert(what).second)
        tell_(text);
}

void Health::check_rate(double rate)
{
    if (rate > 0.0 && rate < least_rate)
        once("rate", with("%.1f images per second: points move too far from one to the next; at "
                          "least 10 are needed: use more light or a shorter exposure, a smaller "
                          "image, or another USB port",
                          rate));
}

void Health::arrived(int64_t now_us)
{
    if (pictures_++ == 0)
        first_us_ = now_us;
    int64_t passed = now_us - first_us_;
    if (passed < rate_window_us)
        return;
    check_rate(1e6 * static_cast<double>(pictures_ - 1) / static_cast<double>(passed));
    pictures_ = 0;
}

void Health::check_picture(const cv::Mat &picture)
{
    if (checked_) /* the first image is enough, and the check takes a few ms */
        return;
    checked_ = true;
    double grey = cv::mean(grey_of(picture))[0];
    double blur = blur_of(picture);
    if (grey < dark_grey)
        once("dark", with("the image is dark, mean grey level %.0f of 255: use more light or a "
                          "longer exposure",
                          grey));
    else if (grey > bright_grey)
        once("bright", with("the image is overexposed, mean grey level %.0f of 255: use less light "
                            "or a shorter exposure",
                            grey));
    else if (blur > max_blur)
        once("blur", with("the image is blurred (%.2f, sharp is below 0.8): focus the lens and "
                          "keep the camera still",
                          blur));
}

void Health::check_points(const std::vector<Point> &points)
{
    size_t visible = 0;
    for (const Point &point : points)
        visible += point.visible;
    if (visible < few_points)
        once("few", with("only %.0f points: the object needs texture; put print or speckles on "
                         "every link, and make sure that nothing hides it",
                         static_cast<double>(visible)));
    if (visible_ >= 2 * few_points && 2 * visible < visible_)
        once("lost", "half of the points were lost from one image to the next: was the camera "
                     "moved, or did something move too fast?");
    visible_ = visible;
}

} // namespace grrl_track
