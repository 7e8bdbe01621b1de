/* Reads cameras, videos, folders and single images through OpenCV. */
#include "source.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <dirent.h>
#include <sys/stat.h>
#include <vector>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>

namespace grrl_track
{

namespace
{

/* The names in a folder that a test accepts, in natural order. */
template <typename Test> std::vector<std::string> names_in(const std::string &path, Test test)
{
    std::vector<std::string> names;
    DIR *folder = opendir(path.c_str());
    if (folder == nullptr)
        return names;
    while (const dirent *entry = readdir(folder))
        if (test(std::string(entry->d_name)))
            names.emplace_back(entry->d_name);
    (void)closedir(folder);
    std::sort(names.begin(), names.end(), [](const std::string &a, const std::string &b) {
        return strverscmp(a.c_str(), b.c_str()) < 0; /* 2.jpg before 10.jpg */
    });
    return names;
}

bool is_picture(const std::string &name)
{
    size_t dot = name.rfind('.');
    std::string end = dot == std::string::npos ? "" : name.substr(dot + 1);
    std::transform(end.begin(), end.end(), end.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const char *known : {"jpg", "jpeg", "png", "bmp", "pgm", "ppm", "tif", "tiff"})
        if (end == known)
            return true;
    return false;
}

class Video : public Source
{
public:
    explicit Video(cv::VideoCapture capture, bool live) : capture_(std::move(capture)), live_(live)
    {
    }

    bool next(cv::Mat &picture) override
    {
        if (capture_.read(picture) && !picture.empty()) {
            pictures_++;
            return true;
        }
        if (live_)
            problem_ = "the camera delivers no more images; was it unplugged?";
        else if (pictures_ == 0)
            problem_ = "no image in it can be decoded; convert it, for example with "
                       "ffmpeg -i IN -c:v mjpeg -q:v 3 OUT.avi";
        return false;
    }

    double rate() const override { return live_ ? 0.0 : capture_.get(cv::CAP_PROP_FPS); }
    bool live() const override { return live_; }

private:
    cv::VideoCapture capture_;
    bool live_;
    int pictures_ = 0;
};

class Pictures : public Source
{
public:
    explicit Pictures(std::vector<std::string> paths) : paths_(std::move(paths)) {}

    bool next(cv::Mat &picture) override
    {
        if (at_ >= paths_.size())
            return false;
        const std::string &path = paths_[at_++];
        picture = cv::imread(path, cv::IMREAD_COLOR);
        if (picture.empty())
            problem_ = path + ": not a readable image; use JPEG or PNG";
        else if (at_ > 1 && picture.size() != size_)
            problem_ = path + ": it is " + std::to_string(picture.cols) + " x " +
                       std::to_string(picture.rows) + ", the previous ones are " +
                       std::to_string(size_.width) + " x " + std::to_string(size_.height);
        size_ = picture.size();
        return problem_.empty();
    }

private:
    std::vector<std::string> paths_;
    size_t at_ = 0;
    cv::Size size_;
};

} // namespace

std::unique_ptr<Source> open_camera(int number, std::string &problem)
{
    std::string device = "/dev/video" + std::to_string(number);
    struct stat status {
    };
    std::vector<std::string> there =
        names_in("/dev", [](const std::string &name) { return name.rfind("video", 0) == 0; });
    if (stat(device.c_str(), &status) != 0) {
        problem = "there is no camera " + std::to_string(number) + " (" + device + "); ";
        if (there.empty())
            problem += "no camera is connected, or this container has no access to it";
        for (size_t i = 0; i < there.size(); i++)
            problem += (i == 0 ? "there are /dev/" : ", /dev/") + there[i];
        return nullptr;
    }
    cv::VideoCapture capture(number, cv::CAP_V4L2);
    if (!capture.isOpened()) {
        problem =
            device +
            " cannot be opened; is another program using it, and do you have access (group video)?";
        return nullptr;
    }
    return std::make_unique<Video>(std::move(capture), true);
}

std::unique_ptr<Source> open_file(const std::string &path, std::string &problem)
{
    struct stat status {
    };
    if (stat(path.c_str(), &status) != 0) {
        problem = path + ": " + std::strerror(errno);
        return nullptr;
    }
    if (S_ISDIR(status.st_mode)) {
        std::vector<std::string> paths = names_in(path, is_picture);
        for (std::string &name : paths)
            name = path + "/" + name;
        if (paths.empty()) {
            problem = path + ": there are no images in this folder; .jpg and .png are read";
            return nullptr;
        }
        return std::make_unique<Pictures>(std::move(paths));
    }
    if (is_picture(path))
        return std::make_unique<Pictures>(std::vector<std::string>{path});
    cv::VideoCapture capture(path);
    if (!capture.isOpened()) {
        problem = path +
                  ": not a video, or the codec to decode it is missing; convert it, for example "
                  "with ffmpeg -i IN -c:v mjpeg -q:v 3 OUT.avi, or use a folder of images";
        return nullptr;
    }
    return std::make_unique<Video>(std::move(capture), false);
}

} // namespace grrl_track
