/*
 * track_video OBJECT SEED PUSHES FILE [LOOK]: a video of random pushes, as examples/ has one.
 *
 * Every second picture of the simulator's camera, so 15 a second; FILE.avi is MJPG, FILE.mp4 is
 * MPEG-4. Prints the true structure.
 */
#include <cstdio>
#include <cstdlib>
#include <string>

#include <opencv2/videoio.hpp>

#include "eye_bench.hpp"

using namespace grrl_sim;

namespace
{

class Film
{
public:
    Film(const ObjectSpec &object, const CameraLook &look, uint64_t seed, const std::string &path)
        : world_(object, eye_bench::world_of(look), seed), scene_(object, look, seed)
    {
        bool avi = path.size() > 4 && path.substr(path.size() - 4) == ".avi";
        int codec = avi ? cv::VideoWriter::fourcc('M', 'J', 'P', 'G')
                        : cv::VideoWriter::fourcc('m', 'p', '4', 'v');
        (void)writer_.open(path, codec, 15.0, {look.width_px, look.height_px});
    }

    bool open() const { return writer_.isOpened(); }

    void rest(int pictures)
    {
        for (int i = 0; i < 2 * pictures; i++) {
            (void)world_.step_frame();
            shoot();
        }
    }

    void push(const PushCommand &command)
    {
        if (world_.begin_push(command).empty())
            while (world_.step_frame())
                shoot();
    }

    const World &world() const { return world_; }
    int pictures() const { return pictures_; }

private:
    void shoot()
    {
        if (frames_++ % 2 != 0)
            return;
        writer_.write(scene_.draw(world_.true_poses(), world_.finger_position()));
        pictures_++;
    }

    World world_;
    Scene scene_;
    cv::VideoWriter writer_;
    int frames_ = 0;
    int pictures_ = 0;
};

} // namespace

int main(int argc, char **argv)
{
    if (argc < 5)
        return 2;
    Result<ObjectSpec> object = object_from_text(argv[1]);
    CameraLook look;
    std::string problem = argc > 5 ? parse_camera_look(argv[5], look) : "";
    if (!object || !problem.empty()) {
        (void)std::fprintf(stderr, "track_video: %s%s%s\n", object.error.c_str(),
                           problem.empty() ? "" : "LOOK must be ", problem.c_str());
        return 2;
    }
    uint64_t seed = std::strtoull(argv[2], nullptr, 10);
    Film film(*object.value, look, seed, argv[4]);
    if (!film.open()) {
        (void)std::fprintf(stderr, "track_video: %s cannot be written\n", argv[4]);
        return 1;
    }
    Random random(seed, Stream::PUSH);
    int links = static_cast<int>(object.value->links.size());
    film.rest(5);
    for (int i = 0; i < std::atoi(argv[3]); i++) {
        int link = random.below(links);
        bool other = random.below(2) != 0;
        film.push(random.below(2) != 0 ? eye_bench::push_across(film.world(), link, other)
                                       : eye_bench::push_along(film.world(), link, other));
        film.rest(5);
    }
    (void)std::printf("%s: %d pictures\n", argv[1], film.pictures());
    return 0;
}
