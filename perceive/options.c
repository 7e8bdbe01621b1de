/* options.c: the table of grrl-perceive's options. */
#include "options.h"

#include <string.h>
#include <strings.h>

static const struct grrl_program program = {
    .name = "grrl-perceive",
    .usage = "grrl-perceive [OPTION]... TRACKS.csv\n"
             "       grrl-perceive [OPTION]... --log FILE.lcm\n"
             "       grrl-perceive [OPTION]... --handle FILE",
    .intro = "Finds the links and joints behind tracked points from their motion.\n\n"
             "TRACKS.csv, - for standard input: the header names the columns frame,point,x,y (or "
             "x_px,y_px)\nand optionally visible (0 or 1), in any order; other columns are "
             "ignored. Separators may be ; or\ntabs; quotes, empty cells and the column names of "
             "common trackers are understood, too:\ndocs/perceive.md.\n",
    .outro =
        "Profiles:\n"
        "  tracker  above a table: noise 0.7 mm; sparse points that never move are background\n"
        "  camera   pixels, the camera may move: noise 1 px, model error 1.2 px, no static "
        "background\n"
        "A handle file has rows x y, x y z, or x y z and a quaternion, in metres unless "
        "--unit says\notherwise.\n\n"
        "Exit status: 0 fine; 1 the input is wrong or cannot be read; 2 wrong command line.\n",
    .max_arguments = 1,
    .arguments = "one file of tracks only",
};

static const char *take_unit(void *context, const char *text)
{
    enum grrl_unit unit = strcmp(text, "m") == 0    ? GRRL_UNIT_M
                          : strcmp(text, "mm") == 0 ? GRRL_UNIT_MM
                          : strcmp(text, "px") == 0 ? GRRL_UNIT_PX
                                                    : GRRL_UNIT_AS_IN_FILE;
    *(enum grrl_unit *)context = unit;
    return unit != GRRL_UNIT_AS_IN_FILE ? NULL : "m, mm or px";
}

static const char *take_profile(void *context, const char *text)
{
    enum grrl_profile profile = strcmp(text, "tracker") == 0  ? GRRL_PROFILE_TRACKER
                                : strcmp(text, "camera") == 0 ? GRRL_PROFILE_CAMERA
                                                              : GRRL_PROFILE_OF_UNIT;
    *(enum grrl_profile *)context = profile;
    return profile != GRRL_PROFILE_OF_UNIT ? NULL : "tracker or camera";
}

static const char *take_noise(void *context, const char *text)
{
    struct grrl_perceive_options *options = context;
    double noise = 0.0;
    options->noise_from_points = strcmp(text, "auto") == 0;
    bool good = options->noise_from_points || grrl_option_number_of(text, &noise);
    options->noise = (float)noise;
    return good && (options->noise_from_points || options->noise > 0.0f)
               ? NULL
               : "a number above 0, or auto";
}

static const char *take_rectify(void *context, const char *text)
{
    struct grrl_perceive_options *options = context;
    struct grrl_rectify_point point[GRRL_RECTIFY_POINTS];
    const char *wrong = grrl_rectify_parse(text, point);
    options->rectifies = true;
    return wrong != NULL ? wrong : grrl_rectify_from(point, &options->rectify);
}

/* Pictures are always SVG; a name with another extension would mislead the next program. */
static const char *take_svg(void *context, const char *text)
{
    static const char *const others[] = {".png", ".jpg",  ".jpeg", ".gif", ".bmp",
                                         ".tif", ".tiff", ".webp", ".pdf", ".eps"};
    size_t length = strlen(text);
    *(const char **)context = text;
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        size_t n = strlen(others[i]);
        if (length > n && strcasecmp(text + length - n, others[i]) == 0)
            return "a file for SVG, such as picture.svg; convert it afterwards";
    }
    return NULL;
}

/* What is wrong with the combination of options, or NULL. */
static const char *contradiction(const struct grrl_perceive_options *options)
{
    int inputs = (options->tracks != NULL) + (options->log != NULL) + (options->handle != NULL);
    if (inputs != 1)
        return inputs == 0 ? "no input: name a file of tracks, --log FILE or --handle FILE"
                           : "one input only: tracks, --log FILE or --handle FILE";
    if (options->trial != 0 && options->log == NULL)
        return "--trial needs --log FILE";
    if (options->log != NULL && options->unit != GRRL_UNIT_AS_IN_FILE)
        return "--unit does not work with --log FILE: messages are in metres";
    if (options->handle != NULL && (options->svg != NULL || options->motion != NULL ||
                                    options->profile != GRRL_PROFILE_OF_UNIT))
        return "--svg, --motion and --profile do not work with --handle FILE";
    if (options->handle != NULL && options->noise_from_points)
        return "--noise auto does not work with --handle FILE: more than noise bends a trajectory";
    if (options->handle != NULL && options->unit == GRRL_UNIT_PX)
        return "--handle FILE is in m or mm";
    if (options->rectifies && (options->log != NULL || options->handle != NULL))
        return "--rectify is for a file of tracks in pixels";
    if (options->rectifies && options->unit == GRRL_UNIT_PX)
        return "with --rectify the unit is that of the table: --unit m or mm";
    if (options->profile == GRRL_PROFILE_CAMERA && !options->rectifies &&
        (options->log != NULL || options->unit == GRRL_UNIT_M || options->unit == GRRL_UNIT_MM))
        return "--profile camera is for positions in pixels";
    return NULL;
}

enum grrl_options_result grrl_perceive_options_parse(int argc, char **argv,
                                                     struct grrl_perceive_options *options)
{
    *options = (struct grrl_perceive_options){0};
    const struct grrl_option rows[] = {
        grrl_option_text("log", "FILE", "read the points of an LCM log (channel GRRL_POINTS)",
                         &options->log),
        grrl_option_int("trial", "N", "with --log: this trial (the last one)", 1, INT32_MAX,
                        &options->trial),
        grrl_option_text("handle", "FILE", "find the joint that moves a single point",
                         &options->handle),
        grrl_option_call("unit", "m|mm|px",
                         "unit of the positions (m; px for the columns x_px and y_px)", take_unit,
                         &options->unit),
        grrl_option_call("profile", "tracker|camera",
                         "noise and background (tracker; camera for px)", take_profile,
                         &options->profile),
        grrl_option_call("noise", "X|auto",
                         "standard deviation of a point, in the unit of the file; auto: measure it",
                         take_noise, options),
        grrl_option_call("rectify", "PLACES",
                         "four pixels and their positions on the table in m (or --unit mm),\n"
                         "\"PX,PY=X,Y ..\": the tracks are in pixels, the answer is on the table",
                         take_rectify, options),
        grrl_option_flag("json", "print JSON", &options->json),
        grrl_option_call("svg", "FILE", "draw features, bodies and joints", take_svg,
                         &options->svg),
        grrl_option_text("motion", "FILE",
                         "write the angle or travel of each joint in each frame as CSV",
                         &options->motion),
    };
    int first;
    enum grrl_options_result result =
        grrl_options_parse(&program, rows, sizeof rows / sizeof rows[0], argc, argv, &first);
    if (result != GRRL_OPTIONS_RUN)
        return result;
    options->tracks = first < argc ? argv[first] : NULL;
    const char *wrong = contradiction(options);
    return wrong == NULL ? GRRL_OPTIONS_RUN : grrl_options_wrong(&program, wrong);
}
