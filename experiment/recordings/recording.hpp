/*
 * recording.hpp: a scene as a table of tracks from a camera and a point tracker, with the truth for
 * each point.
 */
#ifndef GRRL_EXPERIMENT_RECORDINGS_RECORDING_HPP
#define GRRL_EXPERIMENT_RECORDINGS_RECORDING_HPP

#include <cstdint>
#include <string>
#include <vector>

#include "scene.hpp"

namespace grrl_experiment::recordings
{

enum class Camera { FIXED, PAN, ROLL, ZOOM, SHAKE, TILT15, TILT30, PERSPECTIVE };
enum class Tracks { WHOLE, LATE, EARLY, RENEWED, EDGES, FROZEN };
enum class Unit { PX, MM, M };

/* The size of the world, and the unit and width of the images. */
struct Size {
    const char *name;
    Unit unit;
    double link_m;
    double picture_px; /* width; 0: no images, positions on the table */
};

/* The conditions of a recording. */
struct Conditions {
    Object object = Object::R;
    Camera camera = Camera::FIXED;
    Tracks tracks = Tracks::WHOLE;
    int points = 20; /* on each link */
    int rate_hz = 30;
    Size size{"px", Unit::PX, 0.3, 1280.0};
};

/* A point of a track. */
struct Seen {
    int32_t id;
    double x; /* in the unit of the recording */
    double y;
};

/* The truth about a track. */
struct TrackTruth {
    int body;
    bool judged; /* false: it leaves its body, so it belongs nowhere */
};

struct Recording {
    Unit unit = Unit::PX;
    std::vector<std::vector<Seen>> frames;
    std::vector<TrackTruth> tracks; /* by id */
    int bodies = 0;                 /* including the ground, body 0 */
    std::vector<Joint> joints;
    std::vector<bool> open; /* of the joints: no motion tells them from none */
    double noise = 0.0;     /* standard deviation of a point, in the unit */
};

/* Four seconds. The object, its motion and the camera depend only on the seed, whatever the tracks.
 */
Recording record(const Conditions &conditions, uint64_t seed);

/* Writes it for grrl-perceive, with the true body of each point in a column that it does not read.
 */
std::string csv_of(const Recording &recording);

} // namespace grrl_experiment::recordings

#endif
