/* The rendered camera: a scene, encoded. */
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "camera.hpp"
#include "scene.hpp"

namespace grrl_sim
{

namespace
{

constexpr int jpeg_quality = 92;

class DrawnCamera : public Camera
{
public:
    DrawnCamera(const CameraLook &look, PictureCoding coding) : look_(look), coding_(coding) {}

    void begin(const World &world, uint64_t seed) override
    {
        scene_ = std::make_unique<Scene>(world.object(), look_, seed);
    }

    void take(const World &world, Picture &picture) override
    {
        const cv::Mat &seen = scene_->draw(world.true_poses(), world.finger_position());
        picture.width_px = seen.cols;
        picture.height_px = seen.rows;
        switch (coding_) {
        case PictureCoding::RAW_GREY:
            cv::cvtColor(seen, grey_, cv::COLOR_BGR2GRAY);
            picture.bytes.assign(grey_.datastart, grey_.dataend);
            break;
        case PictureCoding::RAW_BGR:
            picture.bytes.assign(seen.datastart, seen.dataend);
            break;
        case PictureCoding::JPEG:
            cv::imencode(".jpg", seen, picture.bytes, {cv::IMWRITE_JPEG_QUALITY, jpeg_quality});
            break;
        case PictureCoding::PNG:
            cv::imencode(".png", seen, picture.bytes, {cv::IMWRITE_PNG_COMPRESSION, 1});
            break;
        }
    }

private:
    CameraLook look_;
    PictureCoding coding_;
    std::unique_ptr<Scene> scene_;
    cv::Mat grey_;
};

} // namespace

std::unique_ptr<Camera> make_camera(const CameraLook &look, PictureCoding coding)
{
    cv::setNumThreads(1); /* a fixed order of operations, on one core */
    return std::make_unique<DrawnCamera>(look, coding);
}

} // namespace grrl_sim
