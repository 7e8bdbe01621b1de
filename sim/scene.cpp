/* Draws textured links and their shadows on a textured table, then light, lens and noise. */
#include "scene.hpp"

#include <opencv2/imgproc.hpp>

namespace grrl_sim
{

namespace
{

constexpr int texels_per_px = 2;
constexpr double shadow_x_px = 3.0; /* of the light's direction and the links' height */
constexpr double shadow_y_px = 4.0;
constexpr double shadow_soft_px = 1.5;
const cv::Vec3f table_colour(150.0f, 165.0f, 170.0f);
const cv::Vec3f finger_colour(60.0f, 190.0f, 40.0f);

/* A pattern as of print or grain: noise of two sizes, with this standard deviation. */
cv::Mat make_texture(cv::Size size, double deviation, double fine_px, cv::RNG &random)
{
    cv::Mat fine(size, CV_32F);
    cv::Mat coarse(size, CV_32F);
    random.fill(fine, cv::RNG::NORMAL, 0.0, 1.0);
    random.fill(coarse, cv::RNG::NORMAL, 0.0, 1.0);
    cv::GaussianBlur(fine, fine, cv::Size(), fine_px);
    cv::GaussianBlur(coarse, coarse, cv::Size(), 3.0 * fine_px);
    cv::Mat sum = fine / cv::norm(fine, cv::NORM_L2) + 0.6 * coarse / cv::norm(coarse, cv::NORM_L2);
    double scale = deviation * std::sqrt(static_cast<double>(sum.total()) / (1.0 + 0.36));
    return scale * sum;
}

/* Of the pixel around a point that an edge leaves covered; distance to it, inside below 0. */
float coverage(double distance_px)
{
    return static_cast<float>(std::clamp(0.5 - distance_px, 0.0, 1.0));
}

/* To the rectangle's edge, negative inside; local coordinates. */
double edge_distance(const Rectangle &rectangle, Vec2 local)
{
    double x = std::abs(local.x) - rectangle.half_length;
    double y = std::abs(local.y) - rectangle.half_width;
    if (x <= 0.0 || y <= 0.0)
        return std::max(x, y);
    return std::sqrt(x * x + y * y);
}

float bilinear(const cv::Mat &image, double x, double y)
{
    x = std::clamp(x, 0.0, image.cols - 1.001);
    y = std::clamp(y, 0.0, image.rows - 1.001);
    int column = static_cast<int>(x);
    int row = static_cast<int>(y);
    const float fx = static_cast<float>(x - column);
    const float fy = static_cast<float>(y - row);
    const float *upper = image.ptr<float>(row) + column;
    const float *lower = image.ptr<float>(row + 1) + column;
    return (1.0f - fy) * (upper[0] + fx * (upper[1] - upper[0])) +
           fy * (lower[0] + fx * (lower[1] - lower[0]));
}

/* The pixels that a disc around a point may touch. */
cv::Rect box(Vec2 centre, double reach, cv::Size size)
{
    int left = std::max(0, static_cast<int>(std::floor(centre.x - reach)));
    int top = std::max(0, static_cast<int>(std::floor(centre.y - reach)));
    int right = std::min(size.width, static_cast<int>(std::ceil(centre.x + reach)) + 1);
    int bottom = std::min(size.height, static_cast<int>(std::ceil(centre.y + reach)) + 1);
    return {left, top, std::max(0, right - left), std::max(0, bottom - top)};
}

double reach_of(const Rectangle &rectangle)
{
    return length(Vec2{rectangle.half_length, rectangle.half_width}) + 1.0;
}

} // namespace

Scene::Scene(const ObjectSpec &object, const CameraLook &look, uint64_t seed)
    : links_(object.links), look_(look), seed_(seed),
      finger_px_(1000.0 * finger_radius_m / look.mm_per_px)
{
    cv::RNG random(seed * 2654435761u + 1);
    for (const LinkSpec &link : links_) {
        double texel_m = 0.001 * look.mm_per_px / texels_per_px;
        cv::Size size(static_cast<int>(2.0 * link.half_length_m / texel_m) + 4,
                      static_cast<int>(2.0 * link.half_width_m / texel_m) + 4);
        cv::Mat texture = make_texture(size, look.link_texture, 1.2 * texels_per_px, random);
        cv::Vec3f colour(random.uniform(90.0f, 180.0f), random.uniform(90.0f, 150.0f),
                         random.uniform(90.0f, 180.0f));
        patterns_.push_back({texture, colour});
    }
    make_table(random);
    make_light();
    make_lens();
    shadow_.create(look.height_px, look.width_px, CV_32F);
    noise_.create(look.height_px, look.width_px, CV_32F);
    picture_.create(look.height_px, look.width_px, CV_8UC3);
}

void Scene::make_table(cv::RNG &random)
{
    cv::Mat texture =
        make_texture({look_.width_px, look_.height_px}, look_.table_texture, 1.2, random);
    table_.create(texture.size(), CV_32FC3);
    for (int row = 0; row < table_.rows; row++)
        for (int column = 0; column < table_.cols; column++)
            table_.at<cv::Vec3f>(row, column) =
                table_colour + cv::Vec3f::all(texture.at<float>(row, column));
}

/* Full in the upper left corner, least in the lower right one. */
void Scene::make_light()
{
    light_.create(look_.height_px, look_.width_px, CV_32F);
    for (int row = 0; row < light_.rows; row++)
        for (int column = 0; column < light_.cols; column++) {
            double far = 0.5 * (static_cast<double>(column) / light_.cols +
                                static_cast<double>(row) / light_.rows);
            light_.at<float>(row, column) =
                static_cast<float>(look_.brightness * (1.0 - look_.gradient * far));
        }
}

void Scene::make_lens()
{
    if (look_.distortion == 0.0)
        return;
    lens_x_.create(look_.height_px, look_.width_px, CV_32F);
    lens_y_.create(look_.height_px, look_.width_px, CV_32F);
    double s = 0.001 * look_.mm_per_px;
    for (int row = 0; row < lens_x_.rows; row++)
        for (int column = 0; column < lens_x_.cols; column++) {
            Vec2 m = to_m({static_cast<double>(column), static_cast<double>(row)});
            lens_x_.at<float>(row, column) =
                static_cast<float>(0.5 * (look_.width_px - 1) + m.x / s);
            lens_y_.at<float>(row, column) =
                static_cast<float>(0.5 * (look_.height_px - 1) - m.y / s);
        }
}

Vec2 Scene::to_px(Vec2 point_m) const
{
    double s = 0.001 * look_.mm_per_px;
    double half = 0.5 * look_.width_px;
    Vec2 out{point_m.x / s, -point_m.y / s};
    double root = 1.0 - 4.0 * look_.distortion * dot(out, out) / (half * half);
    double stretch = 2.0 / (1.0 + std::sqrt(std::max(0.0, root)));
    return {0.5 * (look_.width_px - 1) + stretch * out.x,
            0.5 * (look_.height_px - 1) + stretch * out.y};
}

Vec2 Scene::to_m(Vec2 point_px) const
{
    double s = 0.001 * look_.mm_per_px;
    double half = 0.5 * look_.width_px;
    Vec2 bent{point_px.x - 0.5 * (look_.width_px - 1), point_px.y - 0.5 * (look_.height_px - 1)};
    Vec2 out = (1.0 / (1.0 + look_.distortion * dot(bent, bent) / (half * half))) * bent;
    return {s * out.x, -s * out.y};
}

Scene::Shape Scene::shape_of(size_t link, const Pose &pose) const
{
    double px = 1000.0 / look_.mm_per_px;
    Vec2 centre{0.5 * (look_.width_px - 1) + pose.position.x * px,
                0.5 * (look_.height_px - 1) - pose.position.y * px};
    return {
        {{centre, -pose.angle}, links_[link].half_length_m * px, links_[link].half_width_m * px},
        &patterns_[link]};
}

/* What light falls on the table, beside links and finger. */
void Scene::shade(const std::vector<Shape> &shapes, std::optional<Vec2> finger_px)
{
    shadow_.setTo(0.0);
    Vec2 offset{shadow_x_px, shadow_y_px};
    auto darken = [&](cv::Rect area, auto distance) {
        for (int row = area.y; row < area.y + area.height; row++)
            for (int column = area.x; column < area.x + area.width; column++) {
                double d = distance(Vec2{static_cast<double>(column), static_cast<double>(row)});
                float dark = coverage(d / (2.0 * shadow_soft_px));
                float &known = shadow_.at<float>(row, column);
                known = std::max(known, dark);
            }
    };
    for (const Shape &shape : shapes) {
        Rectangle cast = shape.rectangle;
        cast.pose.position = cast.pose.position + offset;
        Vec2 d = direction(cast.pose.angle);
        darken(box(cast.pose.position, reach_of(cast) + 2.0 * shadow_soft_px, shadow_.size()),
               [&](Vec2 point) {
                   Vec2 v = point - cast.pose.position;
                   return edge_distance(cast, {dot(d, v), cross(d, v)});
               });
    }
    if (finger_px)
        darken(box(*finger_px + offset, finger_px_ + 3.0, shadow_.size()),
               [&](Vec2 point) { return length(point - *finger_px - offset) - finger_px_; });
    for (int row = 0; row < canvas_.rows; row++) {
        const float *dark = shadow_.ptr<float>(row);
        cv::Vec3f *pixel = canvas_.ptr<cv::Vec3f>(row);
        for (int column = 0; column < canvas_.cols; column++)
            if (dark[column] > 0.0f)
                pixel[column] *= 1.0f - static_cast<float>(look_.shadow) * dark[column];
    }
}

void Scene::draw_link(const Shape &shape)
{
    const Rectangle &r = shape.rectangle;
    Vec2 d = direction(r.pose.angle);
    cv::Rect area = box(r.pose.position, reach_of(r), canvas_.size());
    for (int row = area.y; row < area.y + area.height; row++)
        for (int column = area.x; column < area.x + area.width; column++) {
            Vec2 v = Vec2{static_cast<double>(column), static_cast<double>(row)} - r.pose.position;
            Vec2 local{dot(d, v), cross(d, v)};
            float covered = coverage(edge_distance(r, local));
            if (covered <= 0.0f)
                continue;
            float pattern =
                bilinear(shape.pattern->texture, texels_per_px * (local.x + r.half_length) + 1.0,
                         texels_per_px * (local.y + r.half_width) + 1.0);
            cv::Vec3f colour = shape.pattern->colour + cv::Vec3f::all(pattern);
            cv::Vec3f &pixel = canvas_.at<cv::Vec3f>(row, column);
            pixel += covered * (colour - pixel);
        }
}

void Scene::draw_finger(Vec2 centre_px)
{
    cv::Rect area = box(centre_px, finger_px_ + 1.0, canvas_.size());
    for (int row = area.y; row < area.y + area.height; row++)
        for (int column = area.x; column < area.x + area.width; column++) {
            Vec2 point{static_cast<double>(column), static_cast<double>(row)};
            float covered = coverage(length(point - centre_px) - finger_px_);
            cv::Vec3f &pixel = canvas_.at<cv::Vec3f>(row, column);
            pixel += covered * (finger_colour - pixel);
        }
}

/* Lens and sensor. */
void Scene::expose()
{
    const cv::Mat *seen = &canvas_;
    if (!lens_x_.empty()) {
        cv::remap(canvas_, bent_, lens_x_, lens_y_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
        seen = &bent_;
    }
    if (look_.blur_px > 0.0) {
        cv::GaussianBlur(*seen, bent_, cv::Size(), look_.blur_px);
        seen = &bent_;
    }
    cv::RNG random((seed_ + 1) * 0x9e3779b97f4a7c15u + frame_++);
    random.fill(noise_, cv::RNG::NORMAL, 0.0, look_.noise);
    for (int row = 0; row < picture_.rows; row++) {
        const cv::Vec3f *from = seen->ptr<cv::Vec3f>(row);
        const float *light = light_.ptr<float>(row);
        const float *noise = noise_.ptr<float>(row);
        cv::Vec3b *to = picture_.ptr<cv::Vec3b>(row);
        for (int column = 0; column < picture_.cols; column++)
            for (int c = 0; c < 3; c++)
                to[column][c] =
                    cv::saturate_cast<uchar>(light[column] * from[column][c] + noise[column]);
    }
}

const cv::Mat &Scene::draw(const std::vector<Pose> &poses, std::optional<Vec2> finger)
{
    table_.copyTo(canvas_);
    std::vector<Shape> shapes;
    for (size_t i = 0; i < links_.size(); i++)
        if (!links_[i].fixed)
            shapes.push_back(shape_of(i, poses[i]));
    double px = 1000.0 / look_.mm_per_px;
    std::optional<Vec2> finger_px;
    if (finger)
        finger_px = Vec2{0.5 * (look_.width_px - 1) + finger->x * px,
                         0.5 * (look_.height_px - 1) - finger->y * px};
    shade(shapes, finger_px);
    for (const Shape &shape : shapes)
        draw_link(shape);
    if (finger_px)
        draw_finger(*finger_px);
    expose();
    return picture_;
}

} // namespace grrl_sim
