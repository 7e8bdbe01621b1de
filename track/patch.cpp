/* Registers a patch by Gauss-Newton steps, and judges which of its pixels belong to it. */
#include "patch.hpp"

#include <algorithm>
#include <cmath>

namespace grrl_track
{

namespace
{

constexpr float spread_px = 4.5f; /* of the weights around the centre */
constexpr int max_steps = 8;
constexpr float converged_px = 0.01f;
constexpr float farthest_px = 3.0f; /* from the guess */
constexpr float farthest_rad = 0.3f;
constexpr float tukey = 4.7f;       /* residuals beyond this many deviations have no weight */
constexpr float least_scale = 1.5f; /* grey levels: smaller residuals mean nothing */
constexpr float correlated = 2.0f;  /* smoothing correlates the errors of neighbours */
constexpr float foreign_grey =
    7.0f; /* average residual of a pixel that belongs to something else ... */
constexpr float foreign_deviations = 3.5f;

constexpr int unknowns = 5; /* shift x, shift y, rotation, gain, offset */

} // namespace

/* Weighted normal equations, and sums to judge the fit. */
struct Patch::Normal {
    float matrix[unknowns][unknowns] = {};
    float right[unknowns] = {};
    float weight = 0.0f;      /* robust, sum */
    float full_weight = 0.0f; /* including outliers */
    float squares = 0.0f;     /* of residuals */
    float sum_t = 0.0f;       /* for the correlation */
    float sum_tt = 0.0f;
};

PatchPose operator*(const PatchPose &outer, const PatchPose &inner)
{
    float c = std::cos(outer.angle);
    float s = std::sin(outer.angle);
    return {outer.x + c * inner.x - s * inner.y, outer.y + s * inner.x + c * inner.y,
            outer.angle + inner.angle};
}

PatchPose inverse(const PatchPose &pose)
{
    float c = std::cos(pose.angle);
    float s = std::sin(pose.angle);
    return {-c * pose.x - s * pose.y, s * pose.x - c * pose.y, -pose.angle};
}

float distance(const PatchPose &a, const PatchPose &b)
{
    return std::hypot(a.x - b.x, a.y - b.y);
}

static bool inside(const cv::Mat &image, float x, float y)
{
    return x >= 0.0f && y >= 0.0f && x < static_cast<float>(image.cols - 1) &&
           y < static_cast<float>(image.rows - 1);
}

static float bilinear(const cv::Mat &image, float x, float y)
{
    int column = static_cast<int>(x);
    int row = static_cast<int>(y);
    float fx = x - static_cast<float>(column);
    float fy = y - static_cast<float>(row);
    const float *upper = image.ptr<float>(row) + column;
    const float *lower = image.ptr<float>(row + 1) + column;
    float above = upper[0] + fx * (upper[1] - upper[0]);
    float below = lower[0] + fx * (lower[1] - lower[0]);
    return above + fy * (below - above);
}

bool Patch::take(const cv::Mat &smooth, float x, float y)
{
    const float reach = half + 2.0f;
    if (!inside(smooth, x - reach, y - reach) || !inside(smooth, x + reach, y + reach))
        return false;
    birth_ = {x, y, 0.0f};
    taken_ = 0;
    average(smooth);
    for (int i = 0; i < n; i++) {
        float dx = static_cast<float>(i % side - half);
        float dy = static_cast<float>(i / side - half);
        weight_[static_cast<size_t>(i)] =
            std::exp(-0.5f * (dx * dx + dy * dy) / (spread_px * spread_px));
    }
    return true;
}

void Patch::average(const cv::Mat &smooth)
{
    taken_++;
    float share = 1.0f / static_cast<float>(taken_);
    for (int i = 0; i < static_cast<int>(look_.size()); i++) {
        float dx = static_cast<float>(i % (side + 2) - half - 1);
        float dy = static_cast<float>(i / (side + 2) - half - 1);
        float &value = look_[static_cast<size_t>(i)];
        value += share * (bilinear(smooth, birth_.x + dx, birth_.y + dy) - value);
    }
    make_gradients();
}

void Patch::make_gradients()
{
    constexpr size_t stride = side + 2;
    for (size_t i = 0; i < static_cast<size_t>(n); i++) {
        size_t at = (i / side + 1) * stride + i % side + 1;
        value_[i] = look_[at];
        across_[i] = 0.5f * (look_[at + 1] - look_[at - 1]);
        down_[i] = 0.5f * (look_[at + stride] - look_[at - stride]);
    }
}

bool Patch::sample(const cv::Mat &smooth, const PatchPose &pose)
{
    float c = std::cos(pose.angle);
    float s = std::sin(pose.angle);
    float reach = static_cast<float>(half) * (std::abs(c) + std::abs(s)) + 1.0f;
    if (!inside(smooth, pose.x - reach, pose.y - reach) ||
        !inside(smooth, pose.x + reach, pose.y + reach))
        return false;
    size_t i = 0;
    for (int row = -half; row <= half; row++) {
        float x = pose.x - c * half - s * static_cast<float>(row);
        float y = pose.y - s * half + c * static_cast<float>(row);
        for (int column = -half; column <= half; column++, i++, x += c, y += s)
            seen_[i] = bilinear(smooth, x, y);
    }
    return true;
}

/* A standard deviation, by the median of those pixels that count. */
float Patch::residual_scale() const
{
    std::array<float, n> size;
    size_t m = 0;
    for (size_t i = 0; i < static_cast<size_t>(n); i++)
        if (weight_[i] > 0.2f)
            size[m++] = std::abs(residual_[i]);
    if (m == 0)
        return least_scale;
    auto middle = size.begin() + static_cast<std::ptrdiff_t>(m / 2);
    std::nth_element(size.begin(), middle, size.begin() + static_cast<std::ptrdiff_t>(m));
    return std::max(least_scale, 1.48f * *middle);
}

/* T + J d = gain * I + offset, in the unknowns d, gain and offset. */
void Patch::accumulate(Normal &normal, bool robust)
{
    float reach = tukey * (robust ? residual_scale() : 1.0f);
    for (size_t i = 0; i < static_cast<size_t>(n); i++) {
        float weight = weight_[i];
        if (weight <= 0.0f)
            continue;
        normal.full_weight += weight;
        if (robust) {
            float r = residual_[i] / reach;
            float k = 1.0f - r * r;
            weight *= k > 0.0f ? k * k : 0.0f;
        }
        float dx = static_cast<float>(static_cast<int>(i) % side - half);
        float dy = static_cast<float>(static_cast<int>(i) / side - half);
        float row[unknowns] = {across_[i], down_[i], down_[i] * dx - across_[i] * dy, -seen_[i],
                               -1.0f};
        for (int a = 0; a < unknowns; a++) {
            float left = weight * row[a];
            normal.right[a] -= left * value_[i];
            for (int b = 0; b <= a; b++)
                normal.matrix[a][b] += left * row[b];
        }
        normal.weight += weight;
        normal.squares += weight * residual_[i] * residual_[i];
        normal.sum_t += weight * value_[i];
        normal.sum_tt += weight * value_[i] * value_[i];
    }
}

/* Cholesky, in place; false: the patch does not fix all unknowns. */
static bool factor(float (&m)[unknowns][unknowns])
{
    for (int a = 0; a < unknowns; a++)
        for (int b = 0; b <= a; b++) {
            float sum = m[a][b];
            for (int k = 0; k < b; k++)
                sum -= m[a][k] * m[b][k];
            if (a != b)
                m[a][b] = sum / m[b][b];
            else if (sum <= 1e-5f * m[a][a])
                return false;
            else
                m[a][a] = std::sqrt(sum);
        }
    return true;
}

static void solve(const float (&m)[unknowns][unknowns], float (&x)[unknowns])
{
    for (int a = 0; a < unknowns; a++) {
        for (int k = 0; k < a; k++)
            x[a] -= m[a][k] * x[k];
        x[a] /= m[a][a];
    }
    for (int a = unknowns - 1; a >= 0; a--) {
        for (int k = a + 1; k < unknowns; k++)
            x[a] -= m[k][a] * x[k];
        x[a] /= m[a][a];
    }
}

PatchFit Patch::find(const cv::Mat &smooth, const PatchPose &guess)
{
    PatchFit fit;
    PatchPose pose = guess;
    for (int step = 0; step < max_steps; step++) {
        if (!sample(smooth, pose))
            return fit;
        bool robust = step > 0; /* the gain is not known before */
        for (size_t i = 0; i < static_cast<size_t>(n); i++)
            residual_[i] = robust ? value_[i] - gain_ * seen_[i] - offset_ : 0.0f;
        Normal normal;
        accumulate(normal, robust);
        float x[unknowns];
        std::copy(std::begin(normal.right), std::end(normal.right), x);
        if (normal.weight <= 0.0f || !factor(normal.matrix))
            return fit;
        solve(normal.matrix, x);
        gain_ = x[3];
        offset_ = x[4];
        pose = pose * inverse({x[0], x[1], x[2]});
        if (distance(pose, guess) > farthest_px ||
            std::abs(pose.angle - guess.angle) > farthest_rad)
            return fit;
        float moved = std::hypot(x[0], x[1]) + half * std::abs(x[2]);
        if (!robust || moved > converged_px)
            continue;
        float variance = normal.squares / normal.weight;
        float spread = normal.sum_tt / normal.weight -
                       (normal.sum_t / normal.weight) * (normal.sum_t / normal.weight);
        float along[unknowns] = {1.0f};
        float down[unknowns] = {0.0f, 1.0f};
        solve(normal.matrix, along);
        solve(normal.matrix, down);
        fit.pose = pose;
        fit.share = normal.weight / normal.full_weight;
        fit.correlation =
            spread > 0.0f ? std::sqrt(std::max(0.0f, 1.0f - variance / spread)) : 0.0f;
        fit.sd_px = correlated * std::sqrt(0.5f * variance * (along[0] + down[1]));
        fit.good = gain_ > 0.3f && gain_ < 3.0f;
        return fit;
    }
    return fit;
}

void Patch::remember_residuals()
{
    for (size_t i = 0; i < static_cast<size_t>(n); i++)
        residual_sum_[i] += residual_[i];
    residuals_++;
}

void Patch::judge_pixels()
{
    if (residuals_ == 0)
        return;
    for (size_t i = 0; i < static_cast<size_t>(n); i++)
        residual_[i] = residual_sum_[i] / static_cast<float>(residuals_);
    float limit = std::max(foreign_grey, foreign_deviations * residual_scale());
    for (size_t i = 0; i < static_cast<size_t>(n); i++)
        if (std::abs(residual_[i]) > limit)
            weight_[i] = 0.0f;
    residual_sum_.fill(0.0f);
    residuals_ = 0;
}

float Patch::kept() const
{
    float kept = 0.0f;
    float all = 0.0f;
    for (int i = 0; i < n; i++) {
        float dx = static_cast<float>(i % side - half);
        float dy = static_cast<float>(i / side - half);
        float full = std::exp(-0.5f * (dx * dx + dy * dy) / (spread_px * spread_px));
        all += full;
        kept += weight_[static_cast<size_t>(i)] > 0.0f ? full : 0.0f;
    }
    return kept / all;
}

} // namespace grrl_track
