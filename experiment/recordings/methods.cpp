/* methods.cpp: converts recordings to the input of each method, and its answers to estimates. */
#include "methods.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <map>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "json.hpp"
#include "merging.hpp"
#include "perception/baseline.hpp"
#include "random.hpp"

extern char **environ;

namespace grrl_experiment::recordings
{

const char *const method_names[METHODS] = {"ours", "skill", "bic"};

namespace
{

enum { PICTURES = 12, MAX_TRACKS = 120 };

class Clock
{
public:
    double ms() const
    {
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
            .count();
    }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::string read_all(std::FILE *file)
{
    std::string text;
    char block[4096];
    std::rewind(file);
    for (size_t n; (n = std::fread(block, 1, sizeof block, file)) > 0;)
        text.append(block, n);
    return text;
}

/* The exit status; -1: it could not be run. */
int run(std::vector<std::string> command, std::FILE *input, std::FILE *output, std::FILE *errors)
{
    std::vector<char *> argv;
    for (std::string &word : command)
        argv.push_back(word.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    (void)posix_spawn_file_actions_init(&actions);
    (void)posix_spawn_file_actions_adddup2(&actions, fileno(input), STDIN_FILENO);
    (void)posix_spawn_file_actions_adddup2(&actions, fileno(output), STDOUT_FILENO);
    (void)posix_spawn_file_actions_adddup2(&actions, fileno(errors), STDERR_FILENO);
    pid_t pid;
    int status = -1;
    bool good = posix_spawnp(&pid, argv[0], &actions, nullptr, argv.data(), environ) == 0;
    good = good && waitpid(pid, &status, 0) == pid;
    (void)posix_spawn_file_actions_destroy(&actions);
    return good && WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

bool take_json(const std::string &text, Estimate &estimate)
{
    std::optional<Json> json = read_json(text);
    if (!json || (*json)["format"].text != "grrl-perceive 1")
        return false;
    std::map<std::string, int> link;
    for (const Json &body : (*json)["bodies"].items) {
        link[body["name"].text] = estimate.links;
        for (const Json &id : body["features"].items)
            estimate.features.push_back({static_cast<int32_t>(id.number), estimate.links});
        estimate.links++;
    }
    for (const char *name : {"background", "unassigned"})
        for (const Json &id : (*json)[name].items)
            estimate.features.push_back({static_cast<int32_t>(id.number), no_link});
    for (const Json &joint : (*json)["joints"].items)
        estimate.joints.push_back(
            {link[joint["a"].text], link[joint["b"].text],
             joint["type"].text == "revolute" ? GRRL_REVOLUTE : GRRL_PRISMATIC,
             joint["probability"].number});
    return true;
}

const char *unit_name(Unit unit)
{
    return unit == Unit::PX ? "px" : unit == Unit::MM ? "mm" : "m";
}

/* The tracks visible in most of the frames, in a mixed order, since ids go body by body. */
std::vector<int32_t> longest(const Recording &recording, const std::vector<size_t> &frames,
                             size_t most)
{
    std::vector<int> length(recording.tracks.size(), 0);
    for (size_t frame : frames)
        for (const Seen &seen : recording.frames[frame])
            length[static_cast<size_t>(seen.id)]++;
    std::vector<int32_t> ids(length.size());
    for (size_t id = 0; id < ids.size(); id++)
        ids[id] = static_cast<int32_t>(id);
    grrl_sim::Random random(0, grrl_sim::Stream::PUSH);
    random.shuffle(ids);
    std::stable_sort(ids.begin(), ids.end(), [&](int32_t a, int32_t b) {
        return length[static_cast<size_t>(a)] > length[static_cast<size_t>(b)];
    });
    ids.resize(std::min(ids.size(), most));
    return ids;
}

void to_ids(const Pictures &pictures, Estimate &estimate)
{
    for (auto &[row, link] : estimate.features)
        row = pictures.id[static_cast<size_t>(row)];
}

} // namespace

Answer ask_program(const std::string &program, const Recording &recording)
{
    Answer answer;
    std::FILE *file[3] = {std::tmpfile(), std::tmpfile(), std::tmpfile()};
    std::string csv = csv_of(recording);
    if (file[0] != nullptr && file[1] != nullptr && file[2] != nullptr) {
        (void)std::fwrite(csv.data(), 1, csv.size(), file[0]);
        std::rewind(file[0]);
        Clock clock;
        int status = run({program, "--json", "--unit", unit_name(recording.unit), "-"}, file[0],
                         file[1], file[2]);
        answer.ms = clock.ms();
        answer.failed = status != 0 || !take_json(read_all(file[1]), answer.estimate);
        answer.failure = read_all(file[2]);
        if (status < 0 || status == 127)
            answer.failure = cannot_run;
    } else {
        answer.failed = true;
        answer.failure = std::string("no temporary file: ") + std::strerror(errno);
    }
    for (std::FILE *f : file)
        if (f != nullptr)
            (void)std::fclose(f);
    return answer;
}

Pictures pictures_of(const Recording &recording, int pictures, size_t max_tracks)
{
    size_t frames = recording.frames.size();
    std::vector<size_t> chosen;
    for (int i = 0; i < pictures; i++) {
        size_t frame = static_cast<size_t>(i) * (frames - 1) / static_cast<size_t>(pictures - 1);
        if (chosen.empty() || chosen.back() != frame)
            chosen.push_back(frame);
    }
    Pictures result;
    result.id = longest(recording, chosen, max_tracks);
    std::map<int32_t, size_t> row;
    for (size_t i = 0; i < result.id.size(); i++)
        row[result.id[i]] = i;
    double metres = recording.unit == Unit::M ? 1.0 : 0.001;
    for (size_t frame : chosen) {
        result.places.emplace_back(result.id.size());
        for (const Seen &seen : recording.frames[frame])
            if (row.count(seen.id) > 0)
                result.places.back()[row[seen.id]] = {true, {metres * seen.x, metres * seen.y}};
    }
    return result;
}

Answer ask_skill(const Recording &recording)
{
    Answer answer;
    Clock clock;
    Pictures pictures = pictures_of(recording, PICTURES, MAX_TRACKS);
    perception::Baseline baseline(static_cast<int>(pictures.id.size()));
    for (const auto &places : pictures.places) {
        grrl_sim::Frame frame;
        for (size_t i = 0; i < places.size(); i++)
            if (places[i].seen)
                frame.features.push_back(
                    {static_cast<uint32_t>(i), places[i].at_m.x, places[i].at_m.y});
        baseline.rest({frame});
    }
    answer.estimate = baseline.estimate();
    to_ids(pictures, answer.estimate);
    answer.ms = clock.ms();
    return answer;
}

Answer ask_bic(const Recording &recording)
{
    Answer answer;
    Clock clock;
    Pictures pictures = pictures_of(recording, PICTURES, MAX_TRACKS);
    double sigma_m = recording.unit == Unit::PX ? 0.002 : 0.0014;
    answer.estimate = merge_by_bic(pictures, sigma_m);
    to_ids(pictures, answer.estimate);
    answer.ms = clock.ms();
    return answer;
}

} // namespace grrl_experiment::recordings
