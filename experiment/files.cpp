/* files.cpp: files and folders, on POSIX. */
#include "files.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include <unistd.h>

namespace grrl_experiment
{

namespace
{

[[noreturn]] void fail(const std::string &path)
{
    throw std::runtime_error("cannot write " + path + ": " + std::strerror(errno));
}

} // namespace

std::optional<std::string> read_file(const std::string &path)
{
    std::ifstream file(path, std::ios::binary);
    std::ostringstream text;
    if (!file || !(text << file.rdbuf()))
        return std::nullopt;
    return text.str();
}

void write_file(const std::string &path, const std::string &text)
{
    std::string part = path + ".part";
    std::FILE *file = std::fopen(part.c_str(), "wb");
    if (file == nullptr)
        fail(part);
    bool good = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    good = std::fflush(file) == 0 && good;
    good = fsync(fileno(file)) == 0 && good;
    good = std::fclose(file) == 0 && good;
    if (!good || std::rename(part.c_str(), path.c_str()) != 0)
        fail(path);
}

bool write_outputs(const char *program, const std::string &csv,
                   const std::function<void(std::FILE *)> &print, const std::string &svg,
                   const std::function<bool()> &draw)
{
    std::FILE *file = csv.empty() ? nullptr : std::fopen(csv.c_str(), "w");
    bool written = csv.empty() || file != nullptr;
    if (file != nullptr) {
        print(file);
        written = std::ferror(file) == 0;
        written = std::fclose(file) == 0 && written;
    }
    if (!written)
        (void)std::fprintf(stderr, "%s: %s: %s\n", program, csv.c_str(), std::strerror(errno));
    bool drawn = svg.empty() || draw();
    if (!drawn)
        (void)std::fprintf(
            stderr, "%s: %s: gnuplot failed; is it installed, and can the file be written?\n",
            program, svg.c_str());
    return written && drawn;
}

void make_folder(const std::string &path)
{
    std::error_code error;
    std::filesystem::create_directories(path, error);
    if (error)
        throw std::runtime_error("cannot make the folder " + path + ": " + error.message());
}

std::string csv_field(const std::string &text)
{
    if (text.find_first_of(",\"\n") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (char c : text)
        quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    return quoted + "\"";
}

} // namespace grrl_experiment
