/* options.cpp: the table of grrl-sim's options. */
#include "options.hpp"

#include "cli/options.hpp"

namespace grrl_sim
{

namespace
{

const char *take_look(void *context, const char *text)
{
    static std::string right;
    right = parse_camera_look(text, *static_cast<CameraLook *>(context));
    return right.empty() ? nullptr : right.c_str();
}

} // namespace

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    const std::string outro =
        "What --camera-look can set:\n" + camera_look_help() +
        "\nWithout --lcm-url it uses the environment variable LCM_DEFAULT_URL.\n"
        "Exit status: 0 all trials done or stopped by a signal; 1 failure; 2 wrong\n"
        "command line.\n";
    const grrl_program program = {
        "grrl-sim",
        "grrl-sim --object OBJECT [OPTION]...",
        "Simulates a table with an articulated object, a camera that tracks points, a\n"
        "pushing finger and a supervisor, on LCM, for grrl-agent.\n",
        outro.c_str(),
        0,
        nullptr,
    };
    const grrl_option rows[] = {
        grrl_option_text(
            "object", "OBJECT",
            "chain (RPR), term (D(lb, R(l1, l2))), file, or name (wooden-toy);\nrequired",
            &o.object),
        grrl_option_int("trials", "N", "number of trials (1)", 1, 1000000, &o.trials),
        grrl_option_int("cap", "N", "pushes after which a trial ends unsolved (100)", 1, 1000000,
                        &o.cap),
        grrl_option_u64("seed", "N", "seed of poses, noise and friction (1)", 0, UINT64_MAX,
                        &o.seed),
        grrl_option_number("noise", "MM",
                           "standard deviation of a tracked point, millimetres (0.7)", 0.0, 100.0,
                           0.001, &o.tracker.noise_sigma_m),
        grrl_option_number("dropout", "P", "probability that a point is missing in a frame (0)",
                           0.0, 1.0, 1.0, &o.tracker.dropout_probability),
        grrl_option_number("outliers", "P", "probability that a point is displaced in a frame (0)",
                           0.0, 1.0, 1.0, &o.tracker.outlier_probability),
        grrl_option_flag("camera", "publish images for grrl-track instead of points (needs OpenCV)",
                         &o.camera),
        grrl_option_call("camera-look", "NAME=X[,..]", "appearance of the camera images, see below",
                         take_look, &o.look),
        grrl_option_flag("real-time", "30 frames per second instead of lock-step with the agent",
                         &o.real_time),
        grrl_option_number("agent-timeout", "S",
                           "give up after S seconds without an agent (wait forever)", 0.1, 1e6, 1.0,
                           &o.agent_timeout_s),
        grrl_option_text("log", "FILE", "write every message to an LCM log", &o.log),
        grrl_option_text("results", "FILE", "write trial,pushes,outcome lines (CSV)", &o.results),
        grrl_option_text("lcm-url", "URL", "LCM provider", &o.lcm_url),
        grrl_option_flag("quiet", "print errors only", &o.quiet),
    };
    grrl_options_result result =
        grrl_options_parse(&program, rows, std::size(rows), argc, argv, nullptr);
    if (result == GRRL_OPTIONS_RUN && options.object.empty())
        return grrl_options_wrong(&program, "--object is required, for example --object RPR");
    return result;
}

} // namespace grrl_sim
