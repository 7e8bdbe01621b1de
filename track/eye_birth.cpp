/* Creates new features and selects their neighbours. */
#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "eye.hpp"

namespace grrl_track
{

namespace
{

constexpr int corner_block = 9;
constexpr int edge_px = Patch::half + 4;
/* The smaller eigenvalue of the gradients needed for a position accuracy of about 0.1 and 0.2
 * pixels, at one grey level of noise. */
constexpr float strong_floor = 5.0f;
constexpr float weak_floor = 0.5f;
constexpr size_t reference_rank =
    20; /* of the corner that counts as the best: a few stronger ones are accidents */
constexpr size_t max_neighbours = 8;
constexpr float neighbour_reach_px = 60.0f;

struct Corner {
    float strength;
    cv::Point2f at;
};

/* Noise from the median of the second differences, which texture on less than half of the image
 * does not affect. */
float noise_of(const cv::Mat &grey)
{
    std::vector<int> count(1021, 0);
    int total = 0;
    for (int row = 2; row < grey.rows; row += 4) {
        const uchar *pixel = grey.ptr<uchar>(row);
        for (int column = 2; column + 2 < grey.cols; column += 3, total++)
            count[static_cast<size_t>(
                std::abs(pixel[column - 2] - 2 * pixel[column] + pixel[column + 2]))]++;
    }
    size_t median = 0;
    for (int below = count[0]; 2 * below < total; below += count[++median])
        ;
    return std::max(0.5f, 1.48f * static_cast<float>(median) / std::sqrt(6.0f));
}

/* The local maxima of the smaller eigenvalue, strongest first; ties are ordered by position. */
std::vector<Corner> corners_of(const cv::Mat &smooth, float least)
{
    cv::Mat strength;
    cv::Mat greatest;
    cv::cornerMinEigenVal(smooth, strength, corner_block, 3);
    cv::dilate(strength, greatest, cv::Mat());
    std::vector<Corner> corners;
    for (int row = edge_px; row < strength.rows - edge_px; row++) {
        const float *value = strength.ptr<float>(row);
        const float *most = greatest.ptr<float>(row);
        for (int column = edge_px; column < strength.cols - edge_px; column++)
            if (value[column] >= least && value[column] >= most[column])
                corners.push_back({value[column], cv::Point2f(static_cast<float>(column),
                                                              static_cast<float>(row))});
    }
    std::stable_sort(corners.begin(), corners.end(),
                     [](const Corner &a, const Corner &b) { return a.strength > b.strength; });
    return corners;
}

} // namespace

bool Eye::place_free(cv::Point2f point, float spacing) const
{
    for (const Feature &feature : features_)
        if (!feature.given_up &&
            std::hypot(feature.pose.x - point.x, feature.pose.y - point.y) < spacing)
            return false;
    return true;
}

/* Takes strong corners densely and weak ones sparsely: a table full of points looks like an object.
 */
void Eye::give_birth(const View &view)
{
    float noise = noise_of(grey_);
    float squared = noise * noise;
    std::vector<Corner> corners = corners_of(smooth_, weak_floor * squared);
    if (corners.empty())
        return;
    float best = corners[std::min(corners.size() - 1, reference_rank)].strength;
    float strong = std::max(strong_floor * squared, config_.strong * best);
    int followed = 0;
    int sparse = 0;
    for (const Feature &feature : features_) {
        followed += !feature.given_up;
        sparse += feature.sparse && !feature.given_up;
    }
    size_t first = features_.size();
    for (const Corner &corner : corners) {
        if (followed >= config_.max_points || ids() >= config_.max_ids)
            break;
        bool object = view.object_mask.empty() ||
                      view.object_mask.at<uchar>(cvRound(corner.at.y), cvRound(corner.at.x)) != 0;
        bool weak = corner.strength < strong || !object;
        if (weak && sparse >= config_.max_sparse)
            continue;
        if (hidden(view, corner.at.x, corner.at.y) ||
            !place_free(corner.at, weak ? config_.sparse_spacing_px : config_.spacing_px))
            continue;
        Feature feature;
        if (!feature.patch.take(smooth_, corner.at.x, corner.at.y))
            continue;
        feature.id = next_id_++;
        feature.pose = {corner.at.x, corner.at.y, 0.0f};
        feature.before = feature.pose;
        feature.found = true;
        feature.sparse = weak;
        feature.rest_period = rest_period_;
        features_.push_back(std::move(feature));
        followed++;
        sparse += weak;
    }
    introduce(first);
}

/* Selects neighbours for the newest features, and makes these neighbours of others. */
void Eye::introduce(size_t first)
{
    for (size_t i = first; i < features_.size(); i++) {
        std::vector<std::pair<float, size_t>> near;
        for (size_t k = 0; k < features_.size(); k++) {
            float apart = distance(features_[i].pose, features_[k].pose);
            if (k != i && features_[k].found && features_[k].agrees && apart < neighbour_reach_px)
                near.emplace_back(apart, k);
        }
        std::sort(near.begin(), near.end());
        for (const auto &[apart, k] : near) {
            if (features_[i].neighbours.size() < max_neighbours)
                features_[i].neighbours.push_back(
                    {k, inverse(features_[k].pose) * features_[i].pose});
            if (k < first && features_[k].neighbours.size() < max_neighbours)
                features_[k].neighbours.push_back(
                    {i, inverse(features_[i].pose) * features_[k].pose});
        }
    }
}

} // namespace grrl_track
