/* options.cpp: the table of grrl-track's options. */
#include "options.hpp"

#include "cli/options.hpp"

namespace grrl_track
{

namespace
{

const grrl_program program = {
    "grrl-track",
    "grrl-track [OPTION]... VIDEO|FOLDER|IMAGE\n"
    "       grrl-track [OPTION]... --camera N\n"
    "       grrl-track [OPTION]... --lcm",
    "Tracks features through the images of a stationary camera above a table.\n",
    "Without --scale, --points or --calibration positions are in pixels, y down.\n"
    "Without --lcm-url it uses the environment variable LCM_DEFAULT_URL.\n"
    "Exit status: 0 fine, or stopped by a signal; 1 failed; 2 wrong command line.\n",
    1,
    "one file or folder only",
};

const char *take_points(void *context, const char *text)
{
    static std::string right;
    right = parse_points(text, *static_cast<std::vector<PointPair> *>(context));
    return right.empty() ? nullptr : right.c_str();
}

const char *take_board(void *context, const char *text)
{
    static std::string right;
    right = parse_board(text, *static_cast<Board *>(context));
    return right.empty() ? nullptr : right.c_str();
}

/* What is wrong with the combination of options, or nullptr. */
const char *contradiction(const Options &o)
{
    int inputs = !o.input.empty() + (o.camera >= 0) + o.lcm;
    if (inputs != 1)
        return inputs == 0
                   ? "no input: name a video, a folder or an image, or use --camera N or --lcm"
                   : "one input only: a file, --camera N or --lcm";
    bool reads_calibration = !o.calibration.empty() && o.board.columns == 0;
    int ways = (o.scale_mm > 0.0) + !o.points.empty() + reads_calibration + (o.board.columns > 0);
    if (ways > 1)
        return "only one of --scale, --points and --calibration";
    if (o.board.columns > 0 && (o.calibration.empty() || o.lcm))
        return "--calibrate needs --calibration FILE to write to, and a camera or a file";
    if (o.distortion != 0.0 && o.scale_mm <= 0.0 && o.points.empty())
        return "--distortion needs --scale or --points; --calibrate estimates it";
    if ((o.lcm || o.publish) && ways == 0)
        return "points on LCM are in metres: use --scale, --points or --calibration";
    return nullptr;
}

} // namespace

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    const grrl_option rows[] = {
        grrl_option_int("camera", "N", "images from /dev/videoN", 0, 99, &o.camera),
        grrl_option_flag("lcm", "images from GRRL_IMAGE, points to GRRL_POINTS", &o.lcm),
        grrl_option_flag("publish", "also send points of a camera or a file to GRRL_POINTS",
                         &o.publish),
        grrl_option_text("lcm-url", "URL", "LCM provider", &o.lcm_url),
        grrl_option_number(
            "scale", "MM",
            "the camera looks straight down: millimetres per pixel; the origin\nis in the middle",
            0.01, 100.0, 1.0, &o.scale_mm),
        grrl_option_call("points", "PLACES",
                         "at least four pixels and their positions in metres, \"PX,PY=X,Y ..\"",
                         take_points, &o.points),
        grrl_option_number("distortion", "K",
                           "lens distortion, with --scale or --points: share at half the width",
                           -0.25, 0.25, 1.0, &o.distortion),
        grrl_option_call("calibrate", "CxRxMM",
                         "the first image shows a checkerboard with CxR inner corners", take_board,
                         &o.board),
        grrl_option_text("calibration", "FILE",
                         "read a calibration; with --calibrate write it and end", &o.calibration),
        grrl_option_number("tool-colour", "HUE",
                           "mask everything of this hue: 0 red, 120 green, 240 blue", 0.0, 360.0,
                           1.0, &o.tool_hue),
        grrl_option_number("tool-radius", "MM",
                           "radius of the tool at the reported position (10); 0: mask nothing", 0.0,
                           500.0, 1.0, &o.tool_radius_mm),
        grrl_option_text("empty", "PICTURE",
                         "image of the table without the object; unchanged areas get few points",
                         &o.empty),
        grrl_option_text("csv", "FILE",
                         "write frame,point,x,y,visible; - (default) for standard output", &o.csv),
        grrl_option_text("draw", "FILE",
                         "write the images with the tracks: .avi, .mp4 or else a folder", &o.draw),
        grrl_option_int("frames", "N", "end after N images", 1, 1000000000, &o.frames),
        grrl_option_flag("quiet", "print errors only", &o.quiet),
    };
    int first = argc;
    grrl_options_result result =
        grrl_options_parse(&program, rows, std::size(rows), argc, argv, &first);
    if (result != GRRL_OPTIONS_RUN)
        return result;
    if (first < argc)
        o.input = argv[first];
    if (const char *wrong = contradiction(o))
        return grrl_options_wrong(&program, wrong);
    if (o.csv.empty() && !o.lcm && !o.publish && o.draw.empty())
        o.csv = "-";
    return result;
}

} // namespace grrl_track
