/* Finds the folder from /proc/self/exe. */
#include "object_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#ifndef GRRL_OBJECTS_FROM_PROGRAM
#error "GRRL_OBJECTS_FROM_PROGRAM comes from the build"
#endif

namespace grrl_sim
{

namespace fs = std::filesystem;

namespace
{

const char *const extension = ".grrl";

/* Lower case, digits and dashes: not l1 or f3, which are links, and no path. */
bool is_name(const std::string &name)
{
    return !name.empty() && name[0] >= 'a' && name[0] <= 'z' &&
           name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
}

} // namespace

std::string object_folder()
{
    std::error_code error;
    fs::path program = fs::read_symlink("/proc/self/exe", error);
    if (error)
        return "";
    return (program.parent_path() / GRRL_OBJECTS_FROM_PROGRAM).lexically_normal().string();
}

std::string object_path(const std::string &name)
{
    std::string folder = object_folder();
    std::error_code error;
    if (!is_name(name) || folder.empty())
        return "";
    fs::path path = fs::path(folder) / (name + extension);
    return fs::is_regular_file(path, error) ? path.string() : "";
}

std::string object_names()
{
    std::error_code error;
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(object_folder(), error))
        if (entry.path().extension() == extension)
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    std::string text;
    for (const std::string &name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text;
}

} // namespace grrl_sim
