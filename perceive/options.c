#define _POSIX_C_SOURCE 200809L

#include "options.h"

#include <errno.h>
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#ifndef GRRL_VERSION
#error "GRRL_VERSION comes from the build"
#endif

enum option_id {
    OPT_LOG = 256,
    OPT_TRIAL,
    OPT_HANDLE,
    OPT_UNIT,
    OPT_PROFILE,
    OPT_NOISE,
    OPT_JSON,
    OPT_SVG,
    OPT_MOTION,
    OPT_HELP,
    OPT_VERSION
};

/* The one list of options: getopt's table and --help are both made from it. */
static const struct {
    enum option_id id;
    const char *name;
    const char *argument; /* NULL: it has none */
    const char *help;
} table[] = {
    {OPT_LOG, "log", "FILE", "read the points of an LCM log (channel GRRL_POINTS)"},
    {OPT_TRIAL, "trial", "N", "with --log: this trial (the last one)"},
    {OPT_HANDLE, "handle", "FILE", "tell by the trajectory of one point what moves it"},
    {OPT_UNIT, "unit", "m|mm|px", "of the positions (m; px for the columns x_px and y_px)"},
    {OPT_PROFILE, "profile", "tracker|camera", "what the noise is like (camera for px)"},
    {OPT_NOISE, "noise", "X|auto",
     "standard deviation of a point, in the file's unit; auto: measure"},
    {OPT_JSON, "json", NULL, "print JSON"},
    {OPT_SVG, "svg", "FILE", "draw features, bodies and joints"},
    {OPT_MOTION, "motion", "FILE", "write what each joint turns or slides in each frame, as CSV"},
    {OPT_HELP, "help", NULL, "print this text"},
    {OPT_VERSION, "version", NULL, "print the version"},
};

enum { N_OPTIONS = sizeof table / sizeof table[0] };

static const char help_head[] =
    "Usage: grrl-perceive [OPTION]... TRACKS.csv\n"
    "       grrl-perceive [OPTION]... --log FILE.lcm\n"
    "       grrl-perceive [OPTION]... --handle FILE\n"
    "Finds the links and joints of what tracked points lie on, by how they move.\n\n"
    "TRACKS.csv, - for standard input: the header names the columns frame,point,x,y (or "
    "x_px,y_px)\n"
    "and perhaps visible (0 or 1), in any order; other columns are ignored. Also with ; or tabs,\n"
    "quotes, empty cells, and the columns' names of common trackers: docs/perceive.md.\n\n";

static const char help_tail[] =
    "\n"
    "Profiles:\n"
    "  tracker  above a table: noise 0.7 mm, what is sparse and never moves is background\n"
    "  camera   pixels, the camera may move: noise 1 px, model error 1.2 px, no background at "
    "rest\n"
    "A handle's file has rows x y, x y z or x y z and a quaternion, in metres unless --unit says\n"
    "otherwise.\n"
    "\n"
    "Exit status: 0 fine; 1 the input is wrong or cannot be read; 2 wrong command line.\n";

static void print_help(void)
{
    (void)fputs(help_head, stdout);
    for (size_t i = 0; i < N_OPTIONS; i++) {
        char left[40];
        (void)snprintf(left, sizeof left, "--%s%s%s", table[i].name,
                       table[i].argument != NULL ? " " : "",
                       table[i].argument != NULL ? table[i].argument : "");
        (void)printf("  %-24s %s\n", left, table[i].help);
    }
    (void)fputs(help_tail, stdout);
}

static bool bad(const char *name, const char *text, const char *right)
{
    (void)fprintf(stderr, "grrl-perceive: --%s %s: must be %s\n", name, text, right);
    return false;
}

static bool complain(const char *what)
{
    (void)fprintf(stderr, "grrl-perceive: %s\nTry grrl-perceive --help\n", what);
    return false;
}

static bool parse_unit(const char *text, enum grrl_unit *unit)
{
    *unit = strcmp(text, "m") == 0    ? GRRL_UNIT_M
            : strcmp(text, "mm") == 0 ? GRRL_UNIT_MM
            : strcmp(text, "px") == 0 ? GRRL_UNIT_PX
                                      : GRRL_UNIT_AS_IN_FILE;
    return *unit != GRRL_UNIT_AS_IN_FILE || bad("unit", text, "m, mm or px");
}

static bool parse_profile(const char *text, enum grrl_profile *profile)
{
    *profile = strcmp(text, "tracker") == 0  ? GRRL_PROFILE_TRACKER
               : strcmp(text, "camera") == 0 ? GRRL_PROFILE_CAMERA
                                             : GRRL_PROFILE_OF_UNIT;
    return *profile != GRRL_PROFILE_OF_UNIT || bad("profile", text, "tracker or camera");
}

static bool parse_noise(const char *text, struct grrl_perceive_options *options)
{
    char *end;
    options->noise_from_points = strcmp(text, "auto") == 0;
    options->noise = options->noise_from_points ? 0.0f : strtof(text, &end);
    return options->noise_from_points ||
           (end != text && *end == '\0' && isfinite(options->noise) && options->noise > 0.0f) ||
           bad("noise", text, "a number above 0, or auto");
}

static bool parse_trial(const char *text, int32_t *trial)
{
    char *end;
    errno = 0;
    long parsed = strtol(text, &end, 10);
    if (end == text || *end != '\0' || errno != 0 || parsed < 1 || parsed > INT32_MAX)
        return bad("trial", text, "a whole number from 1");
    *trial = (int32_t)parsed;
    return true;
}

/* A picture is SVG whatever its name; a name that says otherwise misleads the next program. */
static bool check_picture(const char *path)
{
    static const char *const others[] = {".png", ".jpg",  ".jpeg", ".gif", ".bmp",
                                         ".tif", ".tiff", ".webp", ".pdf", ".eps"};
    size_t length = strlen(path);
    for (size_t i = 0; i < sizeof others / sizeof others[0]; i++) {
        size_t n = strlen(others[i]);
        if (length > n && strcasecmp(path + length - n, others[i]) == 0)
            return bad("svg", path, "a file for SVG, such as picture.svg; convert it afterwards");
    }
    return true;
}

static bool take(enum option_id id, const char *text, struct grrl_perceive_options *options)
{
    switch (id) {
    case OPT_LOG:
        options->log = text;
        return true;
    case OPT_TRIAL:
        return parse_trial(text, &options->trial);
    case OPT_HANDLE:
        options->handle = text;
        return true;
    case OPT_UNIT:
        return parse_unit(text, &options->unit);
    case OPT_PROFILE:
        return parse_profile(text, &options->profile);
    case OPT_NOISE:
        return parse_noise(text, options);
    case OPT_JSON:
        options->json = true;
        return true;
    case OPT_SVG:
        options->svg = text;
        return check_picture(text);
    case OPT_MOTION:
        options->motion = text;
        return true;
    default:
        return false;
    }
}

static bool consistent(const struct grrl_perceive_options *options)
{
    int inputs = (options->tracks != NULL) + (options->log != NULL) + (options->handle != NULL);
    if (inputs != 1)
        return complain(inputs == 0 ? "no input: name a file of tracks, --log FILE or --handle FILE"
                                    : "one input only: tracks, --log FILE or --handle FILE");
    if (options->trial != 0 && options->log == NULL)
        return complain("--trial needs --log FILE");
    if (options->log != NULL && options->unit != GRRL_UNIT_AS_IN_FILE)
        return complain("--unit does not go with --log FILE: messages are in metres");
    if (options->handle != NULL && (options->svg != NULL || options->motion != NULL ||
                                    options->profile != GRRL_PROFILE_OF_UNIT))
        return complain("--svg, --motion and --profile do not go with --handle FILE");
    if (options->handle != NULL && options->noise_from_points)
        return complain("--noise auto does not go with --handle FILE: what bends a trajectory is "
                        "more than noise");
    if (options->handle != NULL && options->unit == GRRL_UNIT_PX)
        return complain("--handle FILE is in m or mm");
    if (options->profile == GRRL_PROFILE_CAMERA &&
        (options->log != NULL || options->unit == GRRL_UNIT_M || options->unit == GRRL_UNIT_MM))
        return complain("--profile camera is for positions in pixels");
    return true;
}

static void make_getopt_table(struct option *options)
{
    memset(options, 0, (N_OPTIONS + 1) * sizeof *options);
    for (size_t i = 0; i < N_OPTIONS; i++) {
        options[i].name = table[i].name;
        options[i].has_arg = table[i].argument != NULL ? required_argument : no_argument;
        options[i].val = (int)table[i].id;
    }
}

enum grrl_options_result grrl_perceive_options_parse(int argc, char **argv,
                                                     struct grrl_perceive_options *options)
{
    struct option getopt_table[N_OPTIONS + 1];
    make_getopt_table(getopt_table);
    *options = (struct grrl_perceive_options){0};
    int id;
    while ((id = getopt_long(argc, argv, "", getopt_table, NULL)) != -1) {
        if (id == OPT_HELP) {
            print_help();
            return GRRL_OPTIONS_DONE;
        }
        if (id == OPT_VERSION) {
            (void)printf("grrl-perceive %s\n", GRRL_VERSION);
            return GRRL_OPTIONS_DONE;
        }
        if (id == '?') {
            (void)fprintf(stderr, "Try grrl-perceive --help\n");
            return GRRL_OPTIONS_BAD;
        }
        if (!take((enum option_id)id, optarg, options))
            return GRRL_OPTIONS_BAD;
    }
    if (optind + 1 < argc) {
        complain("one file of tracks only");
        return GRRL_OPTIONS_BAD;
    }
    options->tracks = optind < argc ? argv[optind] : NULL;
    return consistent(options) ? GRRL_OPTIONS_RUN : GRRL_OPTIONS_BAD;
}
