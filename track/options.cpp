/* options.cpp: the table of grrl-track's options. */
#include "options.hpp"

#include "cli/options.hpp"

namespace grrl_track
{

namespace
{

const grrl_program program = {
    "grrl-track",
    "grrl-track [OPTION]... VIDEO|FOLDER|PICTURE\n"
    "       grrl-track [OPTION]... --camera N\n"
    "       grrl-track [OPTION]... --lcm",
    "Follows features through the pictures of a camera that stands still above a table.\n",
    "Without --scale, --points or --calibration positions are in pixels, y down.\n"
    "Without --lcm-url the environment variable LCM_DEFAULT_URL counts.\n"
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

/* What is wrong about the options together, or nullptr. */
const char *contradiction(const Options &o)
{
    int inputs = !o.input.empty() + (o.camera >= 0) + o.lcm;
    if (inputs != 1)
        return inputs == 0 ? "no input: name a video, a folder or a picture, or give --camera N or "
                             "--lcm"
                           : "one input only: a file, --camera N or --lcm";
    bool reads_calibration = !o.calibration.empty() && o.board.columns == 0;
    int ways = (o.scale_mm > 0.0) + !o.points.empty() + reads_calibration + (o.board.columns > 0);
    if (ways > 1)
        return "one way from pixels to metres: --scale, --points or --calibration";
    if (o.board.columns > 0 && (o.calibration.empty() || o.lcm))
        return "--calibrate needs --calibration FILE to write to, and a camera or a file";
    if (o.distortion != 0.0 && o.scale_mm <= 0.0 && o.points.empty())
        return "--distortion goes with --scale or --points; --calibrate finds it itself";
    if ((o.lcm || o.publish) && ways == 0)
        return "points on LCM are in metres: give --scale, --points or --calibration";
    return nullptr;
}

} // namespace

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    const grrl_option rows[] = {
        grrl_option_int("camera", "N", "pictures of /dev/videoN", 0, 99, &o.camera),
        grrl_option_flag("lcm", "pictures from GRRL_IMAGE, points to GRRL_POINTS", &o.lcm),
        grrl_option_flag("publish", "points of a camera or a file to GRRL_POINTS, too", &o.publish),
        grrl_option_text("lcm-url", "URL", "LCM provider", &o.lcm_url),
        grrl_option_number("scale", "MM",
                           "the camera looks straight down: millimetres a pixel, origin in the\n"
                           "middle",
                           0.01, 100.0, 1.0, &o.scale_mm),
        grrl_option_call("points", "PLACES",
                         "four pixels or more and their places in metres, \"PX,PY=X,Y ..\"",
                         take_points, &o.points),
        grrl_option_number("distortion", "K",
                           "of the lens, with --scale or --points: share at half the width", -0.25,
                           0.25, 1.0, &o.distortion),
        grrl_option_call("calibrate", "CxRxMM",
                         "the first picture shows a checkerboard with CxR inner corners",
                         take_board, &o.board),
        grrl_option_text("calibration", "FILE", "read it, or with --calibrate write it and end",
                         &o.calibration),
        grrl_option_number("tool-colour", "HUE",
                           "what has this hue hides the scene: 0 red, 120 green, 240 blue", 0.0,
                           360.0, 1.0, &o.tool_hue),
        grrl_option_number("tool-radius", "MM",
                           "of the tool where the robot reports it (10); 0: it hides nothing", 0.0,
                           500.0, 1.0, &o.tool_radius_mm),
        grrl_option_text("empty", "PICTURE",
                         "of the table without the object: few points where nothing is new",
                         &o.empty),
        grrl_option_text("csv", "FILE",
                         "write frame,point,x,y,visible; - for standard output, the default",
                         &o.csv),
        grrl_option_text("draw", "FILE",
                         "write the pictures with the tracks: .avi, .mp4 or else a folder",
                         &o.draw),
        grrl_option_int("frames", "N", "end after N pictures", 1, 1000000000, &o.frames),
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
