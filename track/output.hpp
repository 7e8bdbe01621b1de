/* output.hpp: tracks as CSV, and drawn into the images. */
#ifndef GRRL_TRACK_OUTPUT_HPP
#define GRRL_TRACK_OUTPUT_HPP

#include <cstdio>
#include <deque>
#include <map>
#include <string>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>

#include "eye.hpp"
#include "table.hpp"

namespace grrl_track
{

/* Rows frame,point,x,y,visible as grrl-perceive reads them: metres, or pixels without a table. */
class Csv
{
public:
    ~Csv();

    /* "-" is standard output. Returns an error message, or an empty text, as below. */
    std::string open(const std::string &path);
    std::string write(int64_t frame, const std::vector<Point> &points, const Table &table);
    std::string close();

private:
    std::FILE *file_ = nullptr;
    std::string path_;
    bool header_ = false;
};

/* Images with the tracks drawn in: FILE.avi or FILE.mp4, or else a folder, which is created. */
class Drawing
{
public:
    std::string open(const std::string &path, cv::Size size, double rate);
    std::string write(const View &view, const std::vector<Point> &points);

    /* Draws each point with its path in the last images. */
    cv::Mat draw(const View &view, const std::vector<Point> &points);

private:
    std::string path_;
    bool folder_ = false;
    int pictures_ = 0;
    cv::VideoWriter writer_;
    std::map<int32_t, std::deque<cv::Point2f>> trails_;
};

} // namespace grrl_track

#endif
