/* options.cpp: the table of grrl-sim's options. */
#include "options.hpp"

#include "cli/options.hpp"

namespace grrl_sim
{

namespace
{

const grrl_program program = {
    "grrl-sim",
    "grrl-sim --object OBJECT [OPTION]...",
    "A table with an articulated object, a camera that tracks points, a finger\n"
    "that pushes, and a supervisor, all on LCM for grrl-agent.\n",
    "Without --lcm-url the environment variable LCM_DEFAULT_URL counts.\n"
    "Exit status: 0 all trials done or stopped by a signal; 1 trouble; 2 wrong\n"
    "command line.\n",
    0,
    nullptr,
};

} // namespace

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    const grrl_option rows[] = {
        grrl_option_text("object", "OBJECT",
                         "chain (RPR), term (D(lb, R(l1, l2))), file, or name (wooden-toy); needed",
                         &o.object),
        grrl_option_int("trials", "N", "trials until the end (1)", 1, 1000000, &o.trials),
        grrl_option_int("cap", "N", "pushes after which a trial is given up (100)", 1, 1000000,
                        &o.cap),
        grrl_option_u64("seed", "N", "seed of poses, noise and friction (1)", 0, UINT64_MAX,
                        &o.seed),
        grrl_option_number("noise", "MM",
                           "standard deviation of a tracked point, millimetres (0.7)", 0.0, 100.0,
                           0.001, &o.tracker.noise_sigma_m),
        grrl_option_number("dropout", "P", "probability of a point to be missing in a frame (0)",
                           0.0, 1.0, 1.0, &o.tracker.dropout_probability),
        grrl_option_number("outliers", "P", "probability of a point to be elsewhere in a frame (0)",
                           0.0, 1.0, 1.0, &o.tracker.outlier_probability),
        grrl_option_flag("real-time", "30 frames a second instead of lock-step with the agent",
                         &o.real_time),
        grrl_option_number("agent-timeout", "S",
                           "give up when no agent is heard for S seconds (wait for ever)", 0.1, 1e6,
                           1.0, &o.agent_timeout_s),
        grrl_option_text("log", "FILE", "write every message to an LCM log", &o.log),
        grrl_option_text("results", "FILE", "write trial,pushes,outcome lines (CSV)", &o.results),
        grrl_option_text("lcm-url", "URL", "LCM provider", &o.lcm_url),
        grrl_option_flag("quiet", "print errors only", &o.quiet),
    };
    grrl_options_result result =
        grrl_options_parse(&program, rows, std::size(rows), argc, argv, nullptr);
    if (result == GRRL_OPTIONS_RUN && options.object.empty())
        return grrl_options_wrong(&program, "--object is needed, for example --object RPR");
    return result;
}

} // namespace grrl_sim
