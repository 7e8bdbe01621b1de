/*
 * grrl-track: points from images, for grrl-perceive and grrl-agent.
 *
 * Exit status: 0 fine, 1 failed, 2 wrong command line.
 */
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <random>

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "health.hpp"
#include "lcm_eye.hpp"
#include "options.hpp"
#include "output.hpp"
#include "source.hpp"

using namespace grrl_track;

namespace
{

constexpr int poll_ms = 50;
constexpr int64_t hint_period_us = 5000000;
constexpr double hue_reach = 15.0; /* degrees to each side */
constexpr int least_saturation = 80;
constexpr int least_value = 40;
constexpr double foreign_grey = 25.0; /* from the empty table */

volatile std::sig_atomic_t stop = 0;

int64_t now_us()
{
    using namespace std::chrono;
    static const auto offset =
        system_clock::now().time_since_epoch() - steady_clock::now().time_since_epoch();
    return duration_cast<microseconds>(steady_clock::now().time_since_epoch() + offset).count();
}

int64_t random_session()
{
    std::random_device device;
    uint64_t bits = static_cast<uint64_t>(device()) << 32 | device();
    int64_t session = static_cast<int64_t>((bits ^ static_cast<uint64_t>(now_us())) & INT64_MAX);
    return session != 0 ? session : 1;
}

bool fail(const std::string &text)
{
    (void)std::fprintf(stderr, "grrl-track: %s\n", text.c_str());
    return false;
}

/* Hue wraps around at red; OpenCV's hue is half the angle. */
cv::Mat mask_of_hue(const cv::Mat &picture, double hue)
{
    cv::Mat hsv;
    cv::Mat mask;
    cv::cvtColor(picture, hsv, cv::COLOR_BGR2HSV);
    for (double turn : {-180.0, 0.0, 180.0}) {
        cv::Mat part;
        cv::inRange(hsv, cv::Scalar(0.5 * (hue - hue_reach) + turn, least_saturation, least_value),
                    cv::Scalar(0.5 * (hue + hue_reach) + turn, 255, 255), part);
        if (mask.empty())
            mask = part;
        else
            mask |= part;
    }
    int margin = 2 * Patch::half - 3;
    cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_RECT, {margin, margin}));
    return mask;
}

/* From images to tracks, whatever the source of the images. */
class Track
{
public:
    explicit Track(const Options &options)
        : options_(options), eye_(EyeConfig{}), health_([&options](const std::string &text) {
              if (!options.quiet)
                  (void)std::fprintf(stderr, "grrl-track: warning: %s\n", text.c_str());
          })
    {
    }

    bool begin(const cv::Mat &picture, double rate);
    bool look(const cv::Mat &picture, Motion motion, std::optional<cv::Point2d> tool_m);
    bool end();

    void new_scene() { eye_.reset(); }
    std::vector<Point> points() const { return eye_.points(); }
    const Table &table() const { return table_; }
    Health &health() { return health_; }
    bool begun() const { return begun_; }
    int64_t frames() const { return frames_; }

private:
    std::string make_table(const cv::Mat &picture);

    const Options &options_;
    Table table_;
    Eye eye_;
    Health health_;
    Csv csv_;
    Drawing drawing_;
    cv::Mat empty_; /* grey */
    cv::Size size_;
    bool begun_ = false;
    int64_t frames_ = 0;
};

std::string Track::make_table(const cv::Mat &picture)
{
    if (options_.scale_mm > 0.0)
        table_.set_scale(picture.size(), options_.scale_mm, options_.distortion);
    else if (!options_.points.empty())
        return table_.set_points(picture.size(), options_.points, options_.distortion);
    else if (!options_.calibration.empty())
        return table_.load(options_.calibration, picture.size());
    return {};
}

bool Track::begin(const cv::Mat &picture, double rate)
{
    size_ = picture.size();
    health_.check_rate(rate);
    health_.check_picture(picture);
    std::string problem = make_table(picture);
    if (problem.empty() && !options_.empty.empty()) {
        empty_ = cv::imread(options_.empty, cv::IMREAD_GRAYSCALE);
        if (empty_.size() != size_)
            problem = "--empty " + options_.empty + ": not an image, or not of the same size, " +
                      std::to_string(size_.width) + " x " + std::to_string(size_.height);
    }
    if (problem.empty() && !options_.csv.empty())
        problem = csv_.open(options_.csv);
    if (problem.empty() && !options_.draw.empty())
        problem = drawing_.open(options_.draw, size_, rate);
    begun_ = problem.empty();
    return begun_ || fail(problem);
}

bool Track::look(const cv::Mat &picture, Motion motion, std::optional<cv::Point2d> tool_m)
{
    if (picture.size() != size_)
        return fail("the size of the images changes");
    View view;
    view.picture = picture;
    view.motion = motion;
    if (tool_m && options_.tool_radius_mm > 0.0) {
        cv::Point2d at = table_.to_px(*tool_m);
        cv::Point2d edge =
            table_.to_px(*tool_m + cv::Point2d(0.001 * options_.tool_radius_mm, 0.0));
        view.tool.push_back({static_cast<float>(at.x), static_cast<float>(at.y),
                             static_cast<float>(cv::norm(edge - at))});
    }
    if (options_.tool_hue >= 0.0 && picture.channels() == 3)
        view.tool_mask = mask_of_hue(picture, options_.tool_hue);
    if (!empty_.empty()) {
        cv::Mat grey;
        cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
        cv::absdiff(grey, empty_, grey);
        cv::GaussianBlur(grey, grey, cv::Size(), 2.0);
        view.object_mask = grey > foreign_grey;
    }
    eye_.look(view);
    std::vector<Point> points = eye_.points();
    health_.check_points(points);
    std::string problem;
    if (!options_.csv.empty())
        problem = csv_.write(frames_, points, table_);
    if (problem.empty() && !options_.draw.empty())
        problem = drawing_.write(view, points);
    frames_++;
    return problem.empty() || fail(problem);
}

bool Track::end()
{
    std::string problem = csv_.close();
    if (!problem.empty())
        return fail(problem);
    if (!options_.quiet)
        (void)std::fprintf(stderr, "grrl-track: %lld images, %d points\n",
                           static_cast<long long>(frames_), eye_.ids());
    return true;
}

lcm_t *open_lcm(const std::string &url)
{
    lcm_t *lcm = lcm_create(url.empty() ? nullptr : url.c_str());
    if (lcm != nullptr && lcm_get_fileno(lcm) >= 0)
        return lcm;
    (void)fail("cannot start LCM. If this machine has no network:\n"
               "  ip link set lo up; ip route add 224.0.0.0/4 dev lo\n"
               "or choose another provider with --lcm-url.");
    if (lcm != nullptr)
        lcm_destroy(lcm);
    return nullptr;
}

/* Handles the messages that have arrived. */
bool handle(lcm_t *lcm, int wait_ms)
{
    int handled = lcm_handle_timeout(lcm, wait_ms);
    while (handled > 0)
        handled = lcm_handle_timeout(lcm, 0);
    return handled >= 0 || stop != 0 || fail("LCM failed to receive");
}

bool track_lcm(const Options &options, Track &track, LcmEye &wire, lcm_t *lcm)
{
    int64_t hinted_us = now_us();
    while (stop == 0 && !wire.finished() &&
           (options.frames == 0 || track.frames() < options.frames)) {
        if (!handle(lcm, poll_ms))
            return false;
        cv::Mat picture;
        Motion motion;
        bool new_scene = false;
        if (!wire.next(picture, motion, new_scene)) {
            if (!wire.pictures_came() && now_us() - hinted_us > hint_period_us && !options.quiet) {
                hinted_us = now_us();
                (void)std::fprintf(stderr, "grrl-track: waiting for images on the same LCM "
                                           "provider: start grrl-sim --camera\n");
            }
            continue;
        }
        if (!track.begun() && !track.begin(picture, 0.0))
            return false;
        if (new_scene)
            track.new_scene();
        if (!track.look(picture, motion, wire.tool()))
            return false;
        wire.publish_points(track.points(), track.table());
    }
    return true;
}

bool track_source(const Options &options, Track &track, Source &source, LcmEye *wire, lcm_t *lcm)
{
    int64_t session = random_session();
    cv::Mat picture;
    while (stop == 0 && (options.frames == 0 || track.frames() < options.frames) &&
           source.next(picture)) {
        if (!track.begun() && !track.begin(picture, source.rate()))
            return false;
        if (source.live())
            track.health().arrived(now_us());
        if (wire != nullptr && !handle(lcm, 0))
            return false;
        if (!track.look(picture, Motion::UNKNOWN, wire != nullptr ? wire->tool() : std::nullopt))
            return false;
        if (wire != nullptr)
            wire->publish_own(session, track.points(), track.table());
    }
    if (!source.problem().empty())
        return fail((options.input.empty() ? "" : options.input + ": ") + source.problem());
    return true;
}

bool calibrate(const Options &options, Source &source)
{
    cv::Mat picture;
    if (!source.next(picture))
        return fail(source.problem().empty() ? "there are no images" : source.problem());
    Table table;
    double error_px = 0.0;
    std::string problem = table.calibrate(picture, options.board, error_px);
    if (problem.empty())
        problem = table.save(options.calibration);
    if (!problem.empty())
        return fail(problem);
    if (!options.quiet)
        (void)std::fprintf(stderr, "grrl-track: corners within %.2f pixels; written to %s\n",
                           error_px, options.calibration.c_str());
    return true;
}

bool run(const Options &options)
{
    std::unique_ptr<Source> source;
    std::string problem;
    if (!options.lcm)
        source = options.camera >= 0 ? open_camera(options.camera, problem)
                                     : open_file(options.input, problem);
    if (!options.lcm && source == nullptr)
        return fail(problem);
    if (options.board.columns > 0)
        return calibrate(options, *source);
    Track track(options);
    if (!options.lcm && !options.publish)
        return track_source(options, track, *source, nullptr, nullptr) && track.end();
    lcm_t *lcm = open_lcm(options.lcm_url);
    if (lcm == nullptr)
        return false;
    bool good;
    {
        LcmEye wire(lcm, now_us, [](const std::string &text) { (void)fail(text); });
        good = options.lcm ? track_lcm(options, track, wire, lcm)
                           : track_source(options, track, *source, &wire, lcm);
    }
    lcm_destroy(lcm);
    return good && track.end();
}

} // namespace

int main(int argc, char **argv)
{
    Options options;
    grrl_options_result parsed = parse_options(argc, argv, options);
    if (parsed != GRRL_OPTIONS_RUN)
        return parsed;
    (void)std::signal(
        SIGINT, [](int) { stop = 1; });
    (void)std::signal(SIGTERM, [](int) { stop = 1; });
    /* Whatever a message claims, no image may be larger than image_t allows. */
    (void)setenv("OPENCV_IO_MAX_IMAGE_PIXELS", "16777216", 0);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
    cv::setNumThreads(1); /* a fixed order of operations, on one core */
    try {
        return run(options) ? 0 : 1;
    } catch (const std::exception &error) {
        (void)fail(error.what());
    }
    return 1;
}
