/* options.cpp: the table of grrl-experiment's options. */
#include "options.hpp"

#include <algorithm>
#include <cstring>
#include <set>
#include <sstream>

#include "cli/options.hpp"
#include "conditions.hpp"
#include "plan.hpp"

namespace grrl_experiment
{

namespace
{

std::string policy_names()
{
    std::string names = "one or more, without repetition, of ";
    for (const Policy &policy : policies())
        names += policy.name + ", ";
    return names + "rules (all of their orders) or an ablation (--help)";
}

const char *take_policies(void *context, const char *value)
{
    static const std::string right = policy_names();
    auto &chosen = *static_cast<std::vector<const Policy *> *>(context);
    const std::string text = value;
    chosen.clear();
    for (size_t at = 0; at <= text.size();) {
        size_t end = std::min(text.find(',', at), text.size());
        const std::string name = text.substr(at, end - at);
        size_t before = chosen.size();
        for (const Policy &policy : policies())
            if (name == "rules" && policy.is_rule)
                chosen.push_back(&policy);
        if (name != "rules" && find_policy(name) != nullptr)
            chosen.push_back(find_policy(name));
        std::set<const Policy *> different(chosen.begin(), chosen.end());
        if (chosen.size() == before || different.size() < chosen.size())
            return right.c_str();
        at = end + 1;
    }
    return nullptr;
}

const char *take_world(void *context, const char *value)
{
    static std::string right;
    auto &worlds = *static_cast<std::vector<std::string> *>(context);
    const std::string text = value;
    Conditions conditions;
    right = text == "grid" ? "" : parse_conditions(text, conditions);
    if (text == "grid")
        worlds.insert(worlds.end(), grid_of_worlds().begin(), grid_of_worlds().end());
    else
        worlds.push_back(text);
    return right.empty() ? nullptr : right.c_str();
}

const char *take_object(void *context, const char *value)
{
    static_cast<std::vector<std::string> *>(context)->push_back(value);
    return nullptr;
}

const char *take_start(void *context, const char *value)
{
    *static_cast<std::string *>(context) = value;
    return *value == '\0' ? "a store that grrl-agent --store wrote, or mixed" : nullptr;
}

const char *take_pretrain(void *context, const char *value)
{
    std::string object;
    int trials = 0;
    if (!split_pretrain(value, object, trials))
        return "an object, a colon and a number of trials from 1 to 10000, such as RRRRR:50";
    return take_object(context, value);
}

/* A stream to live with, or, with a number of trials, to live with before. */
const char *take_stream(void *context, const char *value)
{
    auto &options = *static_cast<Options *>(context);
    std::string object;
    int trials = 0;
    bool before = split_pretrain(value, object, trials);
    if (!is_stream(before ? object : value))
        return "a file such as mixed.stream, or mixed.stream:200 for 200 trials before --then";
    return take_object(before ? &options.pretrain : &options.objects, value);
}

const char *take_seeds(void *context, const char *value)
{
    auto &options = *static_cast<Options *>(context);
    const std::string text = value;
    size_t dots = text.find("..");
    std::string first = text.substr(0, dots);
    std::string last = dots == std::string::npos ? first : text.substr(dots + 2);
    constexpr uint64_t most = 1000000000;
    bool good = grrl_option_integer_of(first.c_str(), 0, most, &options.first_seed) &&
                grrl_option_integer_of(last.c_str(), options.first_seed, most, &options.last_seed);
    return good ? nullptr : "a whole number from 0 to 1000000000, or a range such as 1..5";
}

const char *take_shard(void *context, const char *value)
{
    auto &options = *static_cast<Options *>(context);
    const std::string text = value;
    size_t slash = std::min(text.find('/'), text.size() - 1);
    uint64_t shard = 0;
    uint64_t shards = 0;
    if (!grrl_option_integer_of(text.c_str() + slash + 1, 1, 100000, &shards) ||
        !grrl_option_integer_of(text.substr(0, slash).c_str(), 1, shards, &shard))
        return "two whole numbers such as 3/20: part 3 of 20";
    options.shard = static_cast<int>(shard);
    options.shards = static_cast<int>(shards);
    return nullptr;
}

const char *take_transport(void *context, const char *value)
{
    const std::string text = value;
    *static_cast<Transport *>(context) = text == "udpm" ? Transport::UDPM : Transport::MEMQ;
    return text == "udpm" || text == "memq" ? nullptr : "memq or udpm";
}

const char *take_figure(void *context, const char *text)
{
    std::vector<std::string> names = figure_names();
    *static_cast<std::string *>(context) = text;
    return std::find(names.begin(), names.end(), text) != names.end()
               ? nullptr
               : "3b, 4a, 4b, 4c, all, ablations or interference";
}

std::string help_after_options()
{
    std::ostringstream text;
    auto rows = [&text](const std::vector<Policy> &table, size_t width) {
        for (const Policy &policy : table)
            text << "  " << policy.name
                 << std::string(width - std::min(width, policy.name.size()), ' ') << " "
                 << policy.text << "\n";
    };
    text << "Policies:\n";
    rows(policies(), 12);
    text << "\nAblations, by --figure ablations (RPRPRPR) or by name:\n";
    rows(ablations(), 25);
    text << "\nA stream is a file FILE.stream, which describes a distribution of objects. Each "
            "trial\n"
            "draws one: trial t of a seed has the same object for every policy. Statements:\n"
            "links, revolute, branches, loops, objects, size, length, width, friction, such as\n"
            "\"links 3..6, 8\"; see examples/mixed.stream.\n";
    text << "\nWhat --world can change, by a factor unless a unit is given:\n" << conditions_help();
    text << "\nWrites trials.csv, summary.csv, report.html and pictures (SVG, PNG; needs gnuplot)\n"
            "to DIR.\n"
            "An interrupted run resumes there: finished experiments are kept. Further policies,\n"
            "objects and seeds may join them.\n"
            "The same command gives the same CSV for any --jobs and --transport.\n"
            "Exit status: 0 done; 1 failure; 2 wrong command line; 130 interrupted.\n";
    return text.str();
}

/* The error in the combination of options, or nullptr. */
const char *contradiction(const Options &options)
{
    if (options.objects.empty() == options.figure.empty() && options.figure != interference)
        return "give either --figure or --object, for example --object RPR";
    if (!options.figure.empty() && !options.pretrain.empty())
        return "--pretrain requires --object; a figure has its own";
    std::set<std::string> objects(options.objects.begin(), options.objects.end());
    if (objects.size() < options.objects.size())
        return "--object: the same one twice";
    std::set<std::string> worlds(options.worlds.begin(), options.worlds.end());
    if (worlds.size() < options.worlds.size())
        return "--world: the same one twice";
    if (!options.figure.empty() && !options.worlds.empty())
        return "--world requires --object";
    if (options.out.empty())
        return "--out is required: a folder for the results";
    for (const Policy *policy : options.policies)
        if (policy->needs_truth && options.transport != Transport::MEMQ)
            return "--policy clairvoyant: needs the simulator in the same process, "
                   "--transport memq";
    return nullptr;
}

std::string command_of(int argc, char **argv)
{
    std::string command = "grrl-experiment";
    for (int i = 1; i < argc; i++) {
        std::string word = argv[i];
        bool plain = word.find_first_of(" ()'\"$&;*?<>|\\") == std::string::npos;
        command += " " + (plain ? word : "\"" + word + "\"");
    }
    return command;
}

/* grrl-experiment merge --out DIR PART.. */
grrl_options_result parse_merge(int argc, char **argv, Options &options)
{
    const grrl_option rows[] = {
        grrl_option_text("out", "DIR", "folder for all results; required", &options.out),
    };
    const grrl_program program = {
        "grrl-experiment",
        "grrl-experiment merge --out DIR PART...",
        "Joins the results of all parts of a run (--shard) to those of one run.\n",
        nullptr,
        100000,
        nullptr,
    };
    int first = 0;
    grrl_options_result result =
        grrl_options_parse(&program, rows, std::size(rows), argc, argv, &first);
    if (result != GRRL_OPTIONS_RUN)
        return result;
    for (int i = first; i < argc; i++)
        options.merge.emplace_back(argv[i]);
    if (options.out.empty() || options.merge.empty())
        return grrl_options_wrong(&program, "give --out and the folders of all parts");
    return result;
}

grrl_options_result parse_rows(const grrl_option *rows, size_t n, int argc, char **argv,
                               const Options &options)
{
    const std::string outro = help_after_options();
    const grrl_program program = {
        "grrl-experiment",
        "grrl-experiment (--figure NAME | --object OBJECT) --out DIR [OPTION]...\n"
        "       grrl-experiment merge --out DIR PART...",
        "Runs policies that discover the structure of objects over many trials, and compares\n"
        "them: learning curves with intervals, and transfer.\n",
        outro.c_str(),
        0,
        nullptr,
    };
    grrl_options_result result = grrl_options_parse(&program, rows, n, argc, argv, nullptr);
    const char *wrong = result == GRRL_OPTIONS_RUN ? contradiction(options) : nullptr;
    return wrong == nullptr ? result : grrl_options_wrong(&program, wrong);
}

} // namespace

bool split_pretrain(const std::string &text, std::string &object, int &trials)
{
    size_t colon = text.rfind(':');
    uint64_t number = 0;
    if (colon == std::string::npos || colon == 0 ||
        !grrl_option_integer_of(text.c_str() + colon + 1, 1, 10000, &number))
        return false;
    object = text.substr(0, colon);
    trials = static_cast<int>(number);
    return true;
}

std::vector<uint64_t> experiment_seeds(const Options &options)
{
    std::vector<uint64_t> seeds;
    for (uint64_t seed = options.first_seed; seed <= options.last_seed; seed++)
        for (int i = 1; i <= options.experiments; i++)
            seeds.push_back(1000 * seed + static_cast<uint64_t>(i));
    return seeds;
}

std::string shared_arguments(const Options &options)
{
    std::ostringstream text;
    text.precision(15);
    text << "--trials\n" << options.trials << "\n--experiments\n" << options.experiments;
    text << "\n--seed\n" << options.first_seed << ".." << options.last_seed;
    text << "\n--cap\n" << options.cap << "\n--noise\n" << options.noise_mm << "\n";
    if (!options.start.empty())
        text << "--start\n" << options.start << "\n";
    if (!options.figure.empty())
        text << "--figure\n" << options.figure << "\n";
    const std::pair<const char *, const std::vector<std::string> *> lists[] = {
        {"object", &options.objects}, {"pretrain", &options.pretrain}, {"world", &options.worlds}};
    for (const auto &[name, values] : lists)
        for (const std::string &value : *values)
            text << "--" << name << "\n" << value << "\n";
    for (size_t i = 0; i < options.policies.size(); i++)
        text << (i == 0 ? "--policy\n" : ",") << options.policies[i]->name;
    return text.str() + (options.policies.empty() ? "" : "\n");
}

grrl_options_result parse_options(int argc, char **argv, Options &options)
{
    Options &o = options;
    if (argc > 1 && std::strcmp(argv[1], "merge") == 0)
        return parse_merge(argc - 1, argv + 1, options);
    o.command = command_of(argc, argv);
    const grrl_option rows[] = {
        grrl_option_call("figure", "NAME",
                         "of the paper: 3b, 4a, 4b, 4c or all; ablations; or\n"
                         "interference: each object after each other, --trials before",
                         take_figure, &o.figure),
        grrl_option_each("object", "OBJECT",
                         "or: chain (RPR), term (D(lb, R(l1, l2))), file or stream (below);\n"
                         "several add up",
                         take_object, &o.objects),
        grrl_option_call("policy", "NAME[,..]",
                         "policies, see below (learn; with --figure: those of the figure)",
                         take_policies, &o.policies),
        grrl_option_each("pretrain", "OBJECT:N",
                         "with --object: compare with pretraining, N trials on another one;\n"
                         "several add up, in their order",
                         take_pretrain, &o.pretrain),
        grrl_option_call("start", "FILE",
                         "learners start with this store, not with an empty memory; mixed: the\n"
                         "one that comes with grrl",
                         take_start, &o.start),
        grrl_option_each("stream", "FILE[:N]", "as --object FILE, or as --pretrain FILE:N",
                         take_stream, &o),
        grrl_option_each("then", "OBJECT", "after --stream FILE:N: as --object", take_object,
                         &o.objects),
        grrl_option_int("trials", "N", "of an experiment (50)", 1, 10000, &o.trials),
        grrl_option_int("experiments", "N", "each starting without experience (20)", 1, 1000,
                        &o.experiments),
        grrl_option_call("seed", "N[..M]",
                         "experiment i has the seed 1000 N + i (1); a range runs the\n"
                         "experiments of each seed",
                         take_seeds, &o),
        grrl_option_int("jobs", "N", "experiments run in parallel (one per core)", 1, 256, &o.jobs),
        grrl_option_call("shard", "I/N",
                         "run only part I of N of the experiments, without tables and\n"
                         "pictures; merge joins the parts",
                         take_shard, &o),
        grrl_option_text("out", "DIR", "folder for the results; required", &o.out),
        grrl_option_call("transport", "NAME",
                         "memq: agent and simulator in one process; udpm: in two (memq)",
                         take_transport, &o.transport),
        grrl_option_int("cap", "N", "pushes after which a trial ends unsolved (100)", 1, 100000,
                        &o.cap),
        grrl_option_number("noise", "MM", "standard deviation of a tracked point (0.7)", 0.0, 100.0,
                           1.0, &o.noise_mm),
        grrl_option_each("world", "NAME=X[,..]",
                         "a world that differs from the default one, see below; default;\n"
                         "or grid: many worlds",
                         take_world, &o.worlds),
    };
    return parse_rows(rows, std::size(rows), argc, argv, options);
}

} // namespace grrl_experiment
