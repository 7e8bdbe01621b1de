/* perceive.cpp: perception on a whole recording, as grrl-perceive does it, and frame by frame. */
#include "native.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <stdexcept>
#include <tuple>

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

extern "C" {
#include "motion.h"
#include "run.h"
}

namespace grrl_python
{

namespace
{

constexpr double measured = -1.0; /* estimate the noise from the points */

/* A recording with its storage. */
struct Tracks {
    grrl_tracks all{};

    Tracks() = default;
    ~Tracks() { grrl_tracks_free(&all); }
    Tracks(const Tracks &) = delete;
    Tracks &operator=(const Tracks &) = delete;
};

grrl_unit unit_of(const std::string &name)
{
    for (grrl_unit unit : {GRRL_UNIT_PX, GRRL_UNIT_MM, GRRL_UNIT_M})
        if (name == grrl_unit_scale(unit, false).name)
            return unit;
    throw nb::value_error("unit must be 'px', 'mm' or 'm'");
}

double metres_of(grrl_unit unit)
{
    return static_cast<double>(grrl_unit_scale(unit, false).metres);
}

template <typename T> T *copy_of(const T *from, size_t n)
{
    T *to = static_cast<T *>(std::malloc((n + 1) * sizeof(T))); /* never of 0 bytes */
    if (to == nullptr)
        throw std::bad_alloc();
    std::memcpy(to, from, n * sizeof(T));
    return to;
}

using Counts = nb::ndarray<const int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Numbers = nb::ndarray<const int64_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

void check_sizes(const Ids &id, const Floats &x, const Floats &y, const Counts &count,
                 const Numbers &number, const Flags &pushing, const Flags &settled)
{
    size_t points = 0;
    for (size_t f = 0; f < count.shape(0); f++) {
        if (count.data()[f] < 0)
            throw nb::value_error("a frame cannot hold fewer than 0 points");
        points += static_cast<size_t>(count.data()[f]);
    }
    bool good = id.shape(0) == points && x.shape(0) == points && y.shape(0) == points &&
                number.shape(0) == count.shape(0) && pushing.shape(0) == count.shape(0) &&
                settled.shape(0) == count.shape(0);
    if (!good)
        throw nb::value_error("the arrays of a recording do not fit one another");
}

void fill(Tracks &tracks, const Ids &id, const Floats &x, const Floats &y, const Counts &count,
          const Numbers &number, const Flags &pushing, const Flags &settled)
{
    check_sizes(id, x, y, count, number, pushing, settled);
    grrl_tracks &all = tracks.all;
    all.n_points = id.shape(0);
    all.id = copy_of(id.data(), all.n_points);
    all.x = copy_of(x.data(), all.n_points);
    all.y = copy_of(y.data(), all.n_points);
    std::vector<grrl_tracks_frame> frames;
    size_t first = 0;
    for (size_t f = 0; f < count.shape(0); f++) {
        uint32_t n = static_cast<uint32_t>(count.data()[f]);
        frames.push_back({first, number.data()[f], n, pushing.data()[f], settled.data()[f]});
        first += n;
    }
    all.n_frames = frames.size();
    all.frame = copy_of(frames.data(), frames.size());
}

/* One recording on its way to an answer. */
struct Run {
    Tracks tracks;
    grrl_run_config config{};
    grrl_rectify rectify{};
    std::unique_ptr<grrl_run> run = std::make_unique<grrl_run>();

    void perceive(bool drop_lost);
};

void Run::perceive(bool drop_lost)
{
    if (drop_lost && !grrl_tracks_drop_lost(&tracks.all))
        throw std::bad_alloc();
    switch (grrl_run_tracks(run.get(), &config, &tracks.all)) {
    case GRRL_RUN_FINE:
        return;
    case GRRL_RUN_NO_PIXELS:
        throw std::invalid_argument("profile='camera' is for unit='px'");
    case GRRL_RUN_FEW_FOR_NOISE:
        throw std::invalid_argument("noise='auto': too few points that are seen in three frames in "
                                    "a row; give the noise as a number");
    case GRRL_RUN_NO_NOISE:
        throw std::invalid_argument("noise='auto': the points do not scatter, or are rounded; give "
                                    "the noise as a number");
    case GRRL_RUN_BAD_NOISE:
        throw std::invalid_argument("noise is out of range: a number above 0, in the unit of the "
                                    "tracks");
    case GRRL_RUN_TOO_FAR:
        throw std::invalid_argument("every point lies more than 100 m from the origin: is unit= "
                                    "right?");
    case GRRL_RUN_BEYOND:
        throw std::invalid_argument(
            "rectify: every point lies beyond the horizon of the table; are "
            "the four points right?");
    case GRRL_RUN_NOTHING_SEEN:
        throw std::invalid_argument("no point is visible in any frame");
    case GRRL_RUN_OUT_OF_MEMORY:
        throw std::bad_alloc();
    case GRRL_RUN_FAILED:
        break;
    }
    throw std::runtime_error(grrl_status_text(run->status));
}

/* --- how the joints move ---------------------------------------------------------------------- */

struct MemoryFile {
    char *text = nullptr;
    size_t size = 0;
    std::FILE *file = open_memstream(&text, &size);

    MemoryFile() = default;
    ~MemoryFile()
    {
        close();
        std::free(text);
    }
    MemoryFile(const MemoryFile &) = delete;
    MemoryFile &operator=(const MemoryFile &) = delete;

    void close()
    {
        if (file != nullptr)
            (void)std::fclose(file);
        file = nullptr;
    }
};

struct MotionRow {
    long long frame;
    unsigned a;
    unsigned b;
    double value; /* radians or units */
};

/* frame,fA,fB,type,value,unit. Not by sscanf, which measures all the text behind for each row. */
MotionRow row_of(const char *text)
{
    MotionRow row{};
    char *at = nullptr;
    row.frame = std::strtoll(text, &at, 10);
    row.a = static_cast<unsigned>(std::strtoul(at + 2, &at, 10)); /* behind ",f" */
    row.b = static_cast<unsigned>(std::strtoul(at + 2, &at, 10));
    bool slides = at[1] == 'p';
    row.value = std::strtod(std::strchr(at + 1, ',') + 1, nullptr);
    if (!slides)
        row.value *= static_cast<double>(GRRL_PI) / 180.0;
    return row;
}

/* Of joint j in frame f, at j * frames + f: radians or units, NaN where it is not known. */
std::vector<double> motion_of(const grrl_report &report)
{
    const grrl_model &model = *report.model;
    const grrl_tracks &all = *report.recording;
    size_t frames = all.n_frames;
    std::vector<double> motion(model.n_joints * frames, std::numeric_limits<double>::quiet_NaN());
    std::map<std::pair<unsigned, unsigned>, size_t> joint_of;
    for (size_t j = 0; j < model.n_joints; j++)
        joint_of[{model.body[model.joint[j].a].number, model.body[model.joint[j].b].number}] = j;
    std::map<long long, size_t> frame_of;
    for (size_t f = 0; f < frames; f++)
        frame_of[all.frame[f].number] = f;
    MemoryFile memory;
    if (memory.file == nullptr || !grrl_motion_write(memory.file, &report))
        throw std::bad_alloc();
    memory.close();
    const char *line = std::strchr(memory.text, '\n'); /* the header ends */
    while (line != nullptr && line[1] != '\0') {
        MotionRow row = row_of(line + 1);
        motion[joint_of.at({row.a, row.b}) * frames + frame_of.at(row.frame)] = row.value;
        line = std::strchr(line + 1, '\n');
    }
    return motion;
}

/* --- for Python ------------------------------------------------------------------------------- */

nb::dict counts_dict(const grrl_perception_counts &counts)
{
    nb::dict dict;
    dict["frames"] = counts.frames;
    dict["outliers"] = counts.outliers;
    dict["refused"] = counts.refused;
    dict["beyond_capacity"] = counts.overflow;
    dict["thinned"] = counts.thinned;
    dict["keyframes"] = counts.keyframes_high;
    return dict;
}

nb::dict answer_of(const Run &run, bool with_motion)
{
    const grrl_report &report = run.run->report;
    const grrl_tracks &all = run.tracks.all;
    nb::dict dict = model_dict(*report.perception, *report.model, GRRL_RUN_LARGE_M,
                               report.per_metre, report.unit);
    nb::dict counts = counts_dict(*report.counts);
    counts["beyond_capacity"] = all.left_out.n_points + report.counts->overflow;
    counts["empty"] = all.lost.empty;
    counts["marked"] = all.lost.marked;
    counts["frozen"] = all.lost.frozen;
    counts["beyond"] = all.lost.beyond;
    counts["tracks"] = report.tracks;
    counts["tracks_left_out"] = all.left_out.n;
    counts["tracks_joined"] = all.n_renewed;
    dict["counts"] = counts;
    dict["noise"] = report.noise;
    nb::list warnings;
    for (unsigned i = 0; i < report.warnings->n; i++)
        warnings.append(report.warnings->text[i]);
    dict["warnings"] = warnings;
    size_t joints = report.model->n_joints;
    if (with_motion)
        dict["motion"] = array_of(motion_of(run.run->upright), {joints, all.n_frames});
    return dict;
}

/* Without the interpreter's lock: nothing of Python is touched. */
void run_alone(Run &run, bool drop_lost)
{
    std::string wrong;
    {
        nb::gil_scoped_release free;
        try {
            run.perceive(drop_lost);
        } catch (const std::invalid_argument &error) {
            wrong = error.what();
        }
    }
    if (!wrong.empty())
        throw nb::value_error(wrong.c_str());
}

/* Rows of PX, PY, X, Y; none for no rectification. */
void set_rectify(Run &run, const std::vector<double> &places)
{
    grrl_rectify_point point[GRRL_RECTIFY_POINTS];
    if (places.empty())
        return;
    for (size_t i = 0; i < GRRL_RECTIFY_POINTS; i++)
        point[i] = {{places.at(4 * i), places.at(4 * i + 1)},
                    {places.at(4 * i + 2), places.at(4 * i + 3)}};
    const char *wrong = grrl_rectify_from(point, &run.rectify);
    if (wrong != nullptr)
        throw nb::value_error((std::string("rectify must be ") + wrong).c_str());
    run.config.rectify = &run.rectify;
}

/* Positions that a reader found empty, marked and frozen. */
using Lost = std::tuple<size_t, size_t, size_t>;

nb::dict perceive(const Ids &id, const Floats &x, const Floats &y, const Counts &count,
                  const Numbers &number, const Flags &pushing, const Flags &settled,
                  const std::string &unit, const std::string &profile, double noise,
                  const Lost &lost, bool drop_lost, bool said, bool with_motion,
                  const std::vector<double> &rectify)
{
    Run run;
    fill(run.tracks, id, x, y, count, number, pushing, settled);
    run.tracks.all.lost = {std::get<0>(lost), std::get<1>(lost), std::get<2>(lost), 0};
    run.config.unit = unit_of(unit);
    run.config.unit_said = said;
    run.config.profile = profile == "camera" ? GRRL_PROFILE_CAMERA : GRRL_PROFILE_TRACKER;
    run.config.noise = noise == measured ? 0.0f : static_cast<float>(noise);
    run.config.noise_from_points = noise == measured;
    set_rectify(run, rectify);
    run_alone(run, drop_lost);
    return answer_of(run, with_motion);
}

/* path: as the file system has it, which need not be UTF-8. */
nb::dict read_csv(const nb::bytes &name)
{
    const std::string path(name.c_str(), name.size());
    if (path.find('\0') != std::string::npos)
        throw nb::value_error("a path cannot hold a null character");
    Tracks tracks;
    grrl_tracks_error error{};
    std::FILE *file = std::fopen(path.c_str(), "r");
    if (file == nullptr) {
        PyErr_SetFromErrnoWithFilenameObject(
            PyExc_OSError, nb::steal(PyUnicode_DecodeFSDefault(path.c_str())).ptr());
        throw nb::python_error();
    }
    bool good = grrl_tracks_read_csv(file, path.c_str(), &tracks.all, &error);
    (void)std::fclose(file);
    if (!good)
        throw nb::value_error(error.text);
    const grrl_tracks &all = tracks.all;
    std::vector<int32_t> count;
    std::vector<int64_t> number;
    for (size_t f = 0; f < all.n_frames; f++) {
        count.push_back(static_cast<int32_t>(all.frame[f].n));
        number.push_back(all.frame[f].number);
    }
    nb::dict dict;
    dict["id"] = array_of(std::vector<int32_t>(all.id, all.id + all.n_points), {all.n_points});
    dict["x"] = array_of(std::vector<float>(all.x, all.x + all.n_points), {all.n_points});
    dict["y"] = array_of(std::vector<float>(all.y, all.y + all.n_points), {all.n_points});
    dict["count"] = array_of(std::move(count), {all.n_frames});
    dict["number"] = array_of(std::move(number), {all.n_frames});
    dict["in_pixels"] = all.in_pixels;
    nb::dict lost;
    lost["empty"] = all.lost.empty;
    lost["marked"] = all.lost.marked;
    lost["frozen"] = all.lost.frozen;
    dict["lost"] = lost;
    return dict;
}

class Perception
{
public:
    Perception(const std::string &unit, const std::string &profile, double noise)
        : unit_(unit_of(unit))
    {
        grrl_perception_config config = profile_config(profile, noise, metres_of(unit_));
        must(grrl_perception_init(perception_.get(), &config), "noise");
    }

    void observe(const Frame &frame, bool pushing)
    {
        grrl_frame view = frame.view();
        grrl_perception_observe(perception_.get(), &view, pushing);
    }

    bool update()
    {
        grrl_status status = grrl_perception_update(perception_.get());
        if (status != GRRL_ERR_NONE)
            must(status, "perception");
        return status == GRRL_OK;
    }

    void reset() { grrl_perception_reset(perception_.get()); }

    nb::dict model() const
    {
        const grrl_model &model = *grrl_perception_model(perception_.get());
        double per_metre = 1.0 / metres_of(unit_);
        nb::dict dict = model_dict(*perception_, model, GRRL_RUN_LARGE_M, per_metre,
                                   grrl_unit_scale(unit_, false).name);
        dict["counts"] = counts_dict(perception_->counts);
        dict["noise"] = static_cast<double>(perception_->config.noise_m) * per_metre;
        return dict;
    }

private:
    grrl_unit unit_;
    std::unique_ptr<grrl_perception> perception_ = std::make_unique<grrl_perception>();
};

} // namespace

void bind_perceive(nb::module_ &m)
{
    m.def("perceive", &perceive, nb::arg("ids"), nb::arg("x"), nb::arg("y"), nb::arg("count"),
          nb::arg("number"), nb::arg("pushing"), nb::arg("settled"), nb::arg("unit"),
          nb::arg("profile"), nb::arg("noise"), nb::arg("lost"), nb::arg("drop_lost"),
          nb::arg("said"), nb::arg("motion"), nb::arg("rectify"));
    m.def("read_csv", &read_csv, nb::arg("path"));
    nb::class_<Perception>(m, "Perception")
        .def(nb::init<const std::string &, const std::string &, double>(), nb::arg("unit"),
             nb::arg("profile"), nb::arg("noise"))
        .def("observe", &Perception::observe, nb::arg("frame"), nb::arg("pushing"))
        .def("update", &Perception::update)
        .def("reset", &Perception::reset)
        .def("model", &Perception::model);
}

} // namespace grrl_python
