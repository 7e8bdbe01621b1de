/* Writes tracks as rows of CSV, and draws them into images. */
#include "output.hpp"

#include <cerrno>
#include <cstring>
#include <sys/stat.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace grrl_track
{

namespace
{

constexpr size_t trail_pictures = 45;

bool ends_with(const std::string &text, const std::string &end)
{
    return text.size() >= end.size() &&
           text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/* Gives neighbouring ids distant hues. */
cv::Scalar colour_of(int32_t id)
{
    cv::Mat hsv(1, 1, CV_8UC3, cv::Scalar((id * 67) % 180, 230, 255));
    cv::Mat bgr;
    cv::cvtColor(hsv, bgr, cv::COLOR_HSV2BGR);
    cv::Vec3b c = bgr.at<cv::Vec3b>(0, 0);
    return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
}

} // namespace

Csv::~Csv()
{
    if (file_ != nullptr && file_ != stdout)
        (void)std::fclose(file_);
}

std::string Csv::open(const std::string &path)
{
    path_ = path;
    file_ = path == "-" ? stdout : std::fopen(path.c_str(), "w");
    return file_ != nullptr ? std::string() : path + ": " + std::strerror(errno);
}

/* Flushes, so that rows can be read at once. */
std::string Csv::write(int64_t frame, const std::vector<Point> &points, const Table &table)
{
    if (!header_)
        (void)std::fputs(
            table.known() ? "frame,point,x,y,visible\n" : "frame,point,x_px,y_px,visible\n", file_);
    header_ = true;
    for (const Point &point : points) {
        if (!point.visible) {
            (void)std::fprintf(file_, "%lld,%d,,,0\n", static_cast<long long>(frame), point.id);
            continue;
        }
        cv::Point2d m =
            table.to_m(cv::Point2d(static_cast<double>(point.x), static_cast<double>(point.y)));
        (void)std::fprintf(file_, table.known() ? "%lld,%d,%.6f,%.6f,1\n" : "%lld,%d,%.3f,%.3f,1\n",
                           static_cast<long long>(frame), point.id, m.x, m.y);
    }
    return std::fflush(file_) == 0 ? std::string() : path_ + ": " + std::strerror(errno);
}

std::string Csv::close()
{
    std::FILE *file = file_;
    file_ = nullptr;
    if (file == nullptr || file == stdout)
        return {};
    return std::fclose(file) == 0 ? std::string() : path_ + ": " + std::strerror(errno);
}

std::string Drawing::open(const std::string &path, cv::Size size, double rate)
{
    path_ = path;
    bool avi = ends_with(path, ".avi");
    folder_ = !avi && !ends_with(path, ".mp4");
    if (folder_)
        return mkdir(path.c_str(), 0777) == 0 || errno == EEXIST
                   ? std::string()
                   : path + ": " + std::strerror(errno);
    int codec = avi ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G')
                    : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
    if (writer_.open(path, codec, rate > 0.0 ? rate : 30.0, size))
        return {};
    return path +
           ": cannot write a video there: the folder does not exist or is not writable, or OpenCV "
           "lacks the encoder (" +
           (avi ? "MJPG" : "mp4v") + "); a name without .avi or .mp4 creates a folder of images";
}

cv::Mat Drawing::draw(const View &view, const std::vector<Point> &points)
{
    cv::Mat canvas;
    if (view.picture.channels() == 3)
        view.picture.copyTo(canvas);
    else
        cv::cvtColor(view.picture, canvas, cv::COLOR_GRAY2BGR);
    for (const Disc &disc : view.tool)
        cv::circle(canvas, cv::Point2f(disc.x, disc.y), cvRound(disc.radius), {255, 255, 255}, 1,
                   cv::LINE_AA);
    for (const Point &point : points) {
        std::deque<cv::Point2f> &trail = trails_[point.id];
        if (!point.visible) {
            trail.clear();
            continue;
        }
        cv::Scalar colour = colour_of(point.id);
        trail.emplace_back(point.x, point.y);
        if (trail.size() > trail_pictures)
            trail.pop_front();
        for (size_t i = 1; i < trail.size(); i++)
            cv::line(canvas, trail[i - 1], trail[i], colour, 1, cv::LINE_AA);
        cv::circle(canvas, trail.back(), 3, colour, 1, cv::LINE_AA);
    }
    return canvas;
}

std::string Drawing::write(const View &view, const std::vector<Point> &points)
{
    cv::Mat canvas = draw(view, points);
    if (!folder_) {
        writer_.write(canvas);
        return {};
    }
    char name[32];
    (void)std::snprintf(name, sizeof name, "/%06d.png", ++pictures_);
    return cv::imwrite(path_ + name, canvas) ? std::string() : path_ + name + ": cannot be written";
}

} // namespace grrl_track
