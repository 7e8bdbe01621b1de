#include "options.hpp"

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <getopt.h>

namespace grrl_track
{

namespace
{

bool complain(const std::string &text)
{
    (void)std::fprintf(stderr, "grrl-track: %s\n", text.c_str());
    return false;
}

bool parse_double(const char *name, const char *text, double low, double high, double &value)
{
    char *end;
    double parsed = std::strtod(text, &end);
    if (end == text || *end != '\0' || !(parsed >= low && parsed <= high)) {
        char right[120];
        (void)std::snprintf(right, sizeof right, "--%s %.40s: must be a number from %g to %g", name,
                            text, low, high);
        return complain(right);
    }
    value = parsed;
    return true;
}

bool parse_whole(const char *name, const char *text, double low, double high, double &value)
{
    if (!parse_double(name, text, low, high, value))
        return false;
    return value == static_cast<double>(static_cast<int64_t>(value)) ||
           complain(std::string("--") + name + " " + text + ": must be a whole number");
}

bool told(const char *name, const std::string &problem)
{
    return problem.empty() || complain(std::string("--") + name + " " + problem);
}

/* The one list of options: getopt's table and --help are both made from it. */
struct Row {
    const char *name;
    const char *argument; /* nullptr: it has none */
    const char *help;
    bool (*take)(const char *text, Options &options);
};

const Row table[] = {
    {"camera", "N", "pictures of /dev/videoN",
     [](const char *t, Options &o) {
         double n = 0.0;
         bool good = parse_whole("camera", t, 0, 99, n);
         return o.camera = static_cast<int>(n), good;
     }},
    {"lcm", nullptr, "pictures from GRRL_IMAGE, points to GRRL_POINTS",
     [](const char *, Options &o) { return o.lcm = true; }},
    {"publish", nullptr, "points of a camera or a file to GRRL_POINTS, too",
     [](const char *, Options &o) { return o.publish = true; }},
    {"lcm-url", "URL", "LCM provider",
     [](const char *t, Options &o) { return o.lcm_url = t, true; }},
    {"scale", "MM", "the camera looks straight down: millimetres a pixel, origin in the middle",
     [](const char *t, Options &o) { return parse_double("scale", t, 0.01, 100, o.scale_mm); }},
    {"points", "\"PX,PY=X,Y ..\"", "four pixels or more and their places, metres",
     [](const char *t, Options &o) { return told("points", parse_points(t, o.points)); }},
    {"distortion", "K", "of the lens, with --scale or --points: share at half the width",
     [](const char *t, Options &o) {
         return parse_double("distortion", t, -0.25, 0.25, o.distortion);
     }},
    {"calibrate", "CxRxMM", "the first picture shows a checkerboard with CxR inner corners",
     [](const char *t, Options &o) { return told("calibrate", parse_board(t, o.board)); }},
    {"calibration", "FILE", "read it, or with --calibrate write it and end",
     [](const char *t, Options &o) { return o.calibration = t, true; }},
    {"tool-colour", "HUE", "what has this hue hides the scene: 0 red, 120 green, 240 blue",
     [](const char *t, Options &o) { return parse_double("tool-colour", t, 0, 360, o.tool_hue); }},
    {"tool-radius", "MM", "of the tool where the robot reports it (10); 0: it hides nothing",
     [](const char *t, Options &o) {
         return parse_double("tool-radius", t, 0, 500, o.tool_radius_mm);
     }},
    {"empty", "PICTURE", "of the table without the object: few points where nothing is new",
     [](const char *t, Options &o) { return o.empty = t, true; }},
    {"csv", "FILE", "write frame,point,x,y,visible; - for standard output, the default",
     [](const char *t, Options &o) { return o.csv = t, true; }},
    {"draw", "FILE", "write the pictures with the tracks: .avi, .mp4 or else a folder",
     [](const char *t, Options &o) { return o.draw = t, true; }},
    {"frames", "N", "end after N pictures",
     [](const char *t, Options &o) {
         double n = 0.0;
         bool good = parse_whole("frames", t, 1, 1e12, n);
         return o.frames = static_cast<int64_t>(n), good;
     }},
    {"quiet", nullptr, "print errors only",
     [](const char *, Options &o) { return o.quiet = true; }},
    {"help", nullptr, "print this text", nullptr},
    {"version", nullptr, "print the version", nullptr},
};

void print_help()
{
    (void)std::printf("Usage: grrl-track [OPTION]... VIDEO|FOLDER|PICTURE\n"
                      "       grrl-track [OPTION]... --camera N\n"
                      "       grrl-track [OPTION]... --lcm\n"
                      "Follows features through the pictures of a camera that stands still above a "
                      "table.\n\n");
    for (const Row &row : table) {
        std::string left = std::string("--") + row.name;
        if (row.argument != nullptr)
            left += std::string(" ") + row.argument;
        (void)std::printf("  %-24s %s\n", left.c_str(), row.help);
    }
    (void)std::printf("\nWithout --scale, --points or --calibration positions are in pixels, y "
                      "down.\n"
                      "Without --lcm-url the environment variable LCM_DEFAULT_URL counts.\n"
                      "Exit status: 0 fine, or stopped by a signal; 1 trouble; 2 wrong command "
                      "line.\n");
}

std::vector<option> getopt_table()
{
    std::vector<option> options;
    for (const Row &row : table)
        options.push_back({row.name, row.argument != nullptr ? required_argument : no_argument,
                           nullptr, static_cast<int>(options.size()) + 256});
    options.push_back({nullptr, 0, nullptr, 0});
    return options;
}

bool consistent(Options &o)
{
    int inputs = !o.input.empty() + (o.camera >= 0) + o.lcm;
    if (inputs != 1)
        return complain(inputs == 0 ? "no input: name a video, a folder or a picture, or give "
                                      "--camera N or --lcm"
                                    : "one input only: a file, --camera N or --lcm");
    bool reads_calibration = !o.calibration.empty() && o.board.columns == 0;
    int ways = (o.scale_mm > 0.0) + !o.points.empty() + reads_calibration + (o.board.columns > 0);
    if (ways > 1)
        return complain("one way from pixels to metres: --scale, --points or --calibration");
    if (o.board.columns > 0 && (o.calibration.empty() || o.lcm))
        return complain("--calibrate needs --calibration FILE to write to, and a camera or a file");
    if (o.distortion != 0.0 && o.scale_mm <= 0.0 && o.points.empty())
        return complain("--distortion goes with --scale or --points; --calibrate finds it itself");
    if ((o.lcm || o.publish) && ways == 0)
        return complain("points on LCM are in metres: give --scale, --points or --calibration");
    if (o.csv.empty() && !o.lcm && !o.publish && o.draw.empty())
        o.csv = "-";
    return true;
}

} // namespace

OptionsResult parse_options(int argc, char **argv, Options &options)
{
    std::vector<option> rows = getopt_table();
    int id;
    while ((id = getopt_long(argc, argv, "", rows.data(), nullptr)) != -1) {
        if (id == '?') {
            (void)std::fprintf(stderr, "Try grrl-track --help\n");
            return OptionsResult::BAD;
        }
        const Row &row = table[id - 256];
        if (row.take != nullptr) {
            if (!row.take(optarg, options))
                return OptionsResult::BAD;
            continue;
        }
        if (std::string(row.name) == "help")
            print_help();
        else
            (void)std::printf("grrl-track %s\n", GRRL_VERSION);
        return OptionsResult::DONE;
    }
    if (optind + 1 < argc) {
        complain("one file or folder only");
        return OptionsResult::BAD;
    }
    if (optind < argc)
        options.input = argv[optind];
    return consistent(options) ? OptionsResult::RUN : OptionsResult::BAD;
}

} // namespace grrl_track
