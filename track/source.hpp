/*
 * source.hpp: sources of images: a camera, a video, a folder of images or a single one.
 */
#ifndef GRRL_TRACK_SOURCE_HPP
#define GRRL_TRACK_SOURCE_HPP

#include <memory>
#include <string>

#include <opencv2/core.hpp>

namespace grrl_track
{

class Source
{
public:
    virtual ~Source() = default;

    /* The next image, CV_8UC1 or CV_8UC3. false at the end, or with an error message in problem().
     */
    virtual bool next(cv::Mat &picture) = 0;

    /* Images per second; 0: not known. */
    virtual double rate() const { return 0.0; }

    virtual bool live() const { return false; }
    const std::string &problem() const { return problem_; }

protected:
    std::string problem_;
};

/* On failure NULL, and a message in `problem` that says what would be right. */
std::unique_ptr<Source> open_camera(int number, std::string &problem);
std::unique_ptr<Source> open_file(const std::string &path, std::string &problem);

} // namespace grrl_track

#endif
