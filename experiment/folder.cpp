/* folder.cpp: stores results experiment by experiment, so that a run can resume. */
#include "folder.hpp"

#include <cstdio>
#include <filesystem>
#include <sstream>
#include <stdexcept>

#include <fcntl.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include "files.hpp"

namespace grrl_experiment
{

namespace
{

constexpr int lock_wait_ms = 5000;
constexpr int lock_poll_ms = 100;

/* FNV-1a. */
std::string hash_of(const std::string &bytes)
{
    uint64_t hash = UINT64_C(14695981039346656037);
    for (char byte : bytes)
        hash = (hash ^ static_cast<unsigned char>(byte)) * UINT64_C(1099511628211);
    char text[20];
    (void)std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

std::string settings_of(const Options &options)
{
    std::ostringstream text;
    text << "program " << hash_of(read_file("/proc/self/exe").value_or("")) << "\n"
         << "cap " << options.cap << "\n"
         << "noise " << options.noise_mm << "\n";
    return text.str();
}

/* The first line in which two texts differ, from each of them. */
std::pair<std::string, std::string> difference(const std::string &a, const std::string &b)
{
    std::istringstream from_a(a);
    std::istringstream from_b(b);
    std::string line_a;
    std::string line_b;
    while (line_a == line_b && (from_a || from_b)) {
        if (!std::getline(from_a, line_a))
            line_a = from_b ? "end of file" : line_a;
        if (!std::getline(from_b, line_b))
            line_b = from_a ? "end of file" : line_b;
    }
    return {line_a, line_b};
}

} // namespace

Folder::Folder(const Options &options) : root_(options.out)
{
    make_folder(path("experiments"));
    lock();
    check_settings(settings_of(options));
    write_file(path(arguments_file), shared_arguments(options));
}

Folder::~Folder()
{
    (void)close(lock_fd_);
}

void Folder::lock()
{
    lock_fd_ = open(path("lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (lock_fd_ < 0)
        throw std::runtime_error("cannot write " + path("lock"));
    /* a run that was killed leaves its workers for a moment */
    for (int waited_ms = 0; flock(lock_fd_, LOCK_EX | LOCK_NB) != 0; waited_ms += lock_poll_ms) {
        if (waited_ms >= lock_wait_ms) {
            (void)close(lock_fd_);
            throw std::runtime_error("another grrl-experiment is using " + root_);
        }
        (void)poll(nullptr, 0, lock_poll_ms);
    }
}

void Folder::check_settings(const std::string &settings) const
{
    std::optional<std::string> known = read_file(path(settings_file));
    if (!known) {
        write_file(path(settings_file), settings);
        return;
    }
    if (*known == settings)
        return;
    auto [there, here] = difference(*known, settings);
    throw std::runtime_error(root_ + " holds results with other settings: '" + there +
                             "' there, '" + here + "' here; name another folder or remove it");
}

void Folder::take(const std::string &other) const
{
    for (const char *name : {settings_file, arguments_file}) {
        std::string here = read_file(path(name)).value_or("");
        std::optional<std::string> there = read_file(other + "/" + name);
        if (!there)
            throw std::runtime_error(other + " is no folder of results: it has no " + name);
        auto [its, ours] = difference(*there, here);
        if (*there != here)
            throw std::runtime_error(other + " holds another run: '" + its + "' there, '" + ours +
                                     "' in the first folder or this program");
    }
    for (const auto &entry : std::filesystem::directory_iterator(other + "/experiments"))
        if (entry.path().extension() == ".csv")
            write_file(path("experiments/" + entry.path().filename().string()),
                       read_file(entry.path()).value_or(""));
}

std::string Folder::experiment_path(const Curve &curve, uint64_t seed) const
{
    std::string key = curve.course.key + "\n" + std::to_string(curve.trials()) + "\n";
    if (curve.experience)
        key += hash_of({curve.experience->begin(), curve.experience->end()}) + "\n";
    for (const Course &before : curve.before)
        key += before.key + "\n" + std::to_string(before.trials) + "\n";
    return path("experiments/" + curve.policy->name + "-" + hash_of(key) + "-" +
                std::to_string(seed) + ".csv");
}

std::optional<Trials> Folder::load(const Curve &curve, uint64_t seed) const
{
    std::optional<std::string> text = read_file(experiment_path(curve, seed));
    if (!text)
        return std::nullopt;
    std::istringstream lines(*text);
    std::string line;
    Trials trials;
    while (std::getline(lines, line)) {
        TrialRow row;
        int discovered = 0;
        int end = 0;
        if (std::sscanf(line.c_str(), "%d,%d,%d,%d%n", &row.trial, &row.pushes, &discovered,
                        &row.wrong_joints, &end) != 4 ||
            static_cast<size_t>(end) != line.size())
            return std::nullopt;
        row.discovered = discovered != 0;
        trials.push_back(row);
    }
    if (static_cast<int>(trials.size()) != curve.trials())
        return std::nullopt;
    return trials;
}

void Folder::save(const Curve &curve, uint64_t seed, const Trials &trials) const
{
    std::ostringstream text;
    for (const TrialRow &row : trials)
        text << row.trial << "," << row.pushes << "," << (row.discovered ? 1 : 0) << ","
             << row.wrong_joints << "\n";
    write_file(experiment_path(curve, seed), text.str());
}

void Folder::save_store(const Curve &curve, uint64_t seed, const std::vector<uint8_t> &bytes) const
{
    std::string path = experiment_path(curve, seed);
    path.replace(path.rfind(".csv"), 4, ".store");
    write_file(path, std::string(bytes.begin(), bytes.end()));
}

} // namespace grrl_experiment
