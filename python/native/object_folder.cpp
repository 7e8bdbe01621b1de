/*
 * object_folder.cpp: the objects that come with the package, by name. The simulator's own file of
 * this name looks beside the running program, which here is Python.
 */
#include "object_folder.hpp"

#include <algorithm>
#include <filesystem>
#include <vector>

#include "native.hpp"

namespace fs = std::filesystem;

namespace
{

/* Set once, when the package is imported. */
std::string &folder()
{
    static std::string path;
    return path;
}

} // namespace

void grrl_python::set_object_folder(const std::string &path)
{
    folder() = path;
}

namespace grrl_sim
{

std::string object_folder()
{
    return folder();
}

std::string object_path(const std::string &name)
{
    std::error_code error;
    bool is_name =
        !name.empty() && name[0] >= 'a' && name[0] <= 'z' &&
        name.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789-") == std::string::npos;
    fs::path path = fs::path(folder()) / (name + ".grrl");
    return is_name && fs::is_regular_file(path, error) ? path.string() : "";
}

std::string object_names()
{
    std::error_code error;
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(folder(), error))
        if (entry.path().extension() == ".grrl")
            names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    std::string text;
    for (const std::string &name : names)
        text += (text.empty() ? "" : ", ") + name;
    return text;
}

} // namespace grrl_sim
