/*
 * camera.hpp: what an overhead camera would see of the world, for an image tracker.
 *
 * Rendering needs OpenCV. In a build without it, make_camera returns nothing. The truth stays here:
 * an image holds only pixels.
 */
#ifndef GRRL_SIM_CAMERA_HPP
#define GRRL_SIM_CAMERA_HPP

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "world.hpp"

namespace grrl_sim
{

/* The appearance of the images. Grey levels range from 0 to 255. */
struct CameraLook {
    int width_px = 640; /* 160 .. 1920, even, like the height */
    int height_px = 480;
    double mm_per_px = 1.56; /* 0.5 .. 10 */
    double noise = 2.0;      /* standard deviation of a pixel, grey levels, 0 .. 30 */
    double blur_px = 0.6;    /* standard deviation of the lens' spot, 0 .. 5 */
    double gradient = 0.2;   /* share of the light missing in the darkest corner, 0 .. 0.9 */
    double shadow = 0.35;    /* share of the light missing in a shadow, 0 .. 0.9 */
    double distortion = 0.0; /* of the lens, see scene.hpp; barrel below 0, -0.2 .. 0.2 */
    double table_texture =
        2.5; /* standard deviation of the table's pattern, grey levels, 0 .. 60 */
    double link_texture = 28.0; /* of the links' patterns, 0 .. 60 */
    double brightness = 1.0;    /* of everything, 0 .. 2 */
};

/* Applies a text such as "noise=3,blur=1"; returns an empty text, or what it must be ("a number
 * from 0 to 30 for noise"). */
std::string parse_camera_look(const std::string &text, CameraLook &look);

/* The names that parse_camera_look knows, with their ranges, one per line. */
std::string camera_look_help();

/* The part of the table in the image. */
Vec2 camera_view_m(const CameraLook &look);

enum class PictureCoding { RAW_GREY, RAW_BGR, JPEG, PNG };

struct Picture {
    int width_px = 0;
    int height_px = 0;
    std::vector<uint8_t> bytes;
};

class Camera
{
public:
    virtual ~Camera() = default;

    /* Starts a new scene; the seed determines the patterns of its links and its table. */
    virtual void begin(const World &world, uint64_t seed) = 0;

    /* What is seen now; the noise differs from call to call. The same calls after the same begin
     * give the same bytes. */
    virtual void take(const World &world, Picture &picture) = 0;
};

/* Empty in a build without OpenCV. */
std::unique_ptr<Camera> make_camera(const CameraLook &look, PictureCoding coding);

} // namespace grrl_sim

#endif
