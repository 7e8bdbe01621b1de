/* Tracks features from image to image, recovers lost ones and drops bad ones. */
#include "eye.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

namespace grrl_track
{

namespace
{

constexpr double smooth_px = 0.9; /* removes noise and interpolation artefacts of sharp texture */
constexpr int levels = 3;
const cv::Size window(15, 15);
constexpr float forward_backward_px = 0.7f;
constexpr float least_correlation = 0.8f;
constexpr float least_share = 0.5f;
constexpr float max_sd_px = 0.15f;
constexpr float max_sparse_sd_px = 0.3f;
constexpr float regained_correlation = 0.88f;
constexpr float agree_px = 0.4f; /* from a neighbour's prediction, more with its distance ... */
constexpr float agree_rad = 0.012f;
constexpr float consensus_px = 0.3f; /* ... and from that of all that agree */
constexpr size_t least_agreeing = 2;
constexpr size_t least_share_agreeing = 3; /* one in three: a shadow agrees with itself */
constexpr float moved_px = 0.7f;
constexpr float still_px = 0.35f; /* from image to image */
constexpr size_t still_outliers = 2;
constexpr int least_still_frames = 4;
constexpr int judging_frame = 8; /* of a rest */
constexpr int birth_frame = 3;
constexpr int max_doubts = 2;
constexpr float least_kept = 0.4f;
constexpr float tool_margin_px = Patch::half - 2.0f;

} // namespace

void Eye::reset()
{
    features_.clear();
    first_id_ = next_id_;
    rest_frames_ = 0;
    rest_period_ = 0;
    still_frames_ = 0;
    last_pyramid_.clear();
}

bool Eye::hidden(const View &view, float x, float y) const
{
    for (const Disc &disc : view.tool)
        if (std::hypot(x - disc.x, y - disc.y) < disc.radius + tool_margin_px)
            return true;
    if (view.tool_mask.empty())
        return false;
    int column = std::clamp(cvRound(x), 0, view.tool_mask.cols - 1);
    int row = std::clamp(cvRound(y), 0, view.tool_mask.rows - 1);
    return view.tool_mask.at<uchar>(row, column) != 0;
}

void Eye::prepare(const View &view)
{
    if (view.picture.channels() == 3)
        cv::cvtColor(view.picture, grey_, cv::COLOR_BGR2GRAY);
    else
        view.picture.copyTo(grey_);
    grey_.convertTo(smooth_, CV_32F);
    cv::GaussianBlur(smooth_, smooth_, cv::Size(5, 5), smooth_px);
    std::swap(pyramid_, last_pyramid_);
}

/* Tracks from the last image to this one; the result is where each feature's search starts. */
void Eye::follow(const View &view)
{
    for (Feature &feature : features_) {
        feature.before = feature.pose;
        feature.found = feature.found && !hidden(view, feature.pose.x, feature.pose.y);
    }
    bool still = view.motion == Motion::REST && rest_frames_ > 0;
    cv::buildOpticalFlowPyramid(grey_, pyramid_, window, levels);
    if (still || last_pyramid_.empty())
        return;
    std::vector<Feature *> followed;
    std::vector<cv::Point2f> from;
    for (Feature &feature : features_)
        if (feature.found) {
            followed.push_back(&feature);
            from.emplace_back(feature.pose.x, feature.pose.y);
        }
    if (from.empty())
        return;
    std::vector<cv::Point2f> to(from);
    std::vector<cv::Point2f> back(from);
    std::vector<uchar> there;
    std::vector<uchar> here;
    cv::TermCriteria enough(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 10, 0.03);
    cv::calcOpticalFlowPyrLK(last_pyramid_, pyramid_, from, to, there, cv::noArray(), window,
                             levels, enough);
    cv::calcOpticalFlowPyrLK(pyramid_, last_pyramid_, to, back, here, cv::noArray(), window, levels,
                             enough, cv::OPTFLOW_USE_INITIAL_FLOW);
    for (size_t i = 0; i < followed.size(); i++) {
        cv::Point2f error = back[i] - from[i];
        followed[i]->found = there[i] != 0 && here[i] != 0 &&
                             std::hypot(error.x, error.y) <= forward_backward_px &&
                             !hidden(view, to[i].x, to[i].y);
        followed[i]->pose.x = to[i].x;
        followed[i]->pose.y = to[i].y;
    }
}

bool Eye::accept(Feature &feature, const PatchFit &fit)
{
    float sd_px = feature.sparse ? max_sparse_sd_px : max_sd_px;
    feature.found = fit.good && fit.correlation >= least_correlation && fit.share >= least_share &&
                    fit.sd_px <= sd_px;
    if (feature.found)
        feature.pose = fit.pose;
    return feature.found;
}

void Eye::register_all()
{
    for (Feature &feature : features_)
        if (feature.found && !accept(feature, feature.patch.find(smooth_, feature.pose)))
            feature.pose = feature.before;
}

/* Searches lost features where they were and where visible neighbours predict them. */
void Eye::regain()
{
    for (Feature &feature : features_) {
        if (feature.found || feature.given_up)
            continue;
        std::vector<PatchPose> guesses{feature.pose};
        for (const Neighbour &neighbour : feature.neighbours) {
            const Feature &other = features_[neighbour.feature];
            if (!other.found || !other.agrees)
                continue;
            PatchPose guess = other.pose * neighbour.offset;
            bool known = false;
            for (const PatchPose &tried : guesses)
                known = known || distance(tried, guess) < 1.5f;
            if (!known)
                guesses.push_back(guess);
        }
        PatchFit best;
        for (const PatchPose &guess : guesses) {
            PatchFit fit = feature.patch.find(smooth_, guess);
            if (fit.good && fit.correlation > best.correlation)
                best = fit;
        }
        if (best.correlation >= regained_correlation)
            (void)accept(feature, best);
    }
}

/* Whether enough neighbours predict a feature where it was found; too few neighbours are no reason
 * to doubt. */
bool Eye::agrees(const Feature &feature) const
{
    size_t asked = 0;
    std::vector<cv::Point2f> then; /* of those that agree, in the feature's frame at its birth */
    std::vector<cv::Point2f> now;
    for (const Neighbour &neighbour : feature.neighbours) {
        const Feature &other = features_[neighbour.feature];
        if (!other.found)
            continue;
        asked++;
        PatchPose place = inverse(neighbour.offset);
        float reach = std::hypot(place.x, place.y);
        if (distance(other.pose * neighbour.offset, feature.pose) > agree_px + agree_rad * reach)
            continue;
        then.emplace_back(place.x, place.y);
        now.emplace_back(other.pose.x, other.pose.y);
    }
    if (asked < least_agreeing + 1)
        return true;
    if (now.size() < least_agreeing || least_share_agreeing * now.size() < asked)
        return false;
    /* Where does the rigid motion of those that agree place the feature? */
    float n = static_cast<float>(now.size());
    cv::Point2f a(0.0f, 0.0f);
    cv::Point2f b(0.0f, 0.0f);
    for (size_t i = 0; i < now.size(); i++) {
        a += then[i] * (1.0f / n);
        b += now[i] * (1.0f / n);
    }
    float c = 0.0f;
    float s = 0.0f;
    for (size_t i = 0; i < now.size(); i++) {
        cv::Point2f u = then[i] - a;
        cv::Point2f v = now[i] - b;
        c += u.dot(v);
        s += u.x * v.y - u.y * v.x;
    }
    float norm = std::hypot(c, s);
    if (norm <= 0.0f)
        return true;
    c /= norm;
    s /= norm;
    cv::Point2f expected(b.x - c * a.x + s * a.y, b.y - s * a.x - c * a.y);
    return std::hypot(expected.x - feature.pose.x, expected.y - feature.pose.y) <=
           consensus_px + (now.size() < 3 ? agree_px : 0.0f);
}

void Eye::compare_neighbours()
{
    for (Feature &feature : features_)
        if (feature.found)
            feature.agrees = agrees(feature);
}

/* At rest if the sender says so, or else if all but a few features have stood still for some
 * images. */
void Eye::watch_rest(Motion motion)
{
    size_t moving = 0;
    for (Feature &feature : features_)
        if (feature.found) {
            moving += distance(feature.pose, feature.before) > still_px;
            feature.has_moved =
                feature.has_moved || std::hypot(feature.pose.x - feature.patch.x(),
                                                feature.pose.y - feature.patch.y()) > moved_px;
        }
    still_frames_ = moving <= still_outliers ? still_frames_ + 1 : 0;
    bool rest = motion == Motion::REST ||
                (motion == Motion::UNKNOWN && still_frames_ >= least_still_frames);
    rest_period_ += rest && rest_frames_ == 0;
    rest_frames_ = rest ? rest_frames_ + 1 : 0;
}

/* At rest, averages the appearance of new features and finds pixels that belong to something else.
 */
void Eye::use_rest()
{
    for (Feature &feature : features_) {
        if (!feature.found || !feature.agrees)
            continue;
        if (!feature.has_moved && feature.rest_period == rest_period_ &&
            rest_frames_ < judging_frame)
            feature.patch.average(smooth_);
        if (feature.has_moved && rest_frames_ < judging_frame)
            feature.patch.remember_residuals();
    }
    if (rest_frames_ != judging_frame)
        return;
    for (Feature &feature : features_) {
        if (!feature.found)
            continue;
        feature.doubts = feature.agrees ? feature.doubts : feature.doubts + 1;
        if (feature.agrees)
            feature.patch.judge_pixels();
        if (feature.doubts >= max_doubts || feature.patch.kept() < least_kept) {
            feature.given_up = true;
            feature.found = false;
        }
    }
}

void Eye::look(const View &view)
{
    prepare(view);
    follow(view);
    register_all();
    compare_neighbours();
    if (view.motion != Motion::PUSHING) {
        regain();
        compare_neighbours();
    }
    watch_rest(view.motion);
    if (at_rest())
        use_rest();
    if (features_.empty() || rest_frames_ == birth_frame)
        give_birth(view);
}

std::vector<Point> Eye::points() const
{
    std::vector<Point> points;
    for (const Feature &feature : features_)
        if (!feature.given_up)
            points.push_back(
                {feature.id, feature.pose.x, feature.pose.y, feature.found && feature.agrees});
    return points;
}

} // namespace grrl_track
