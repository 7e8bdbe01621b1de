/* In place of camera_drawn.cpp in a build without OpenCV. */
#include "camera.hpp"

namespace grrl_sim
{

std::unique_ptr<Camera> make_camera(const CameraLook &, PictureCoding)
{
    return nullptr;
}

} // namespace grrl_sim
