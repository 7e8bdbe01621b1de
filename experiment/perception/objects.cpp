/* objects.cpp: the list of objects, and the selection from it. */
#include "objects.hpp"

#include <cstdio>

namespace grrl_experiment::perception
{

using grrl_sim::ObjectSpec;
using grrl_sim::Result;

namespace
{

struct Entry {
    const char *name;
    const char *text; /* nullptr: the name is a chain */
    const char *file; /* or a file of the simulator */
};

const Entry entries[] = {
    {"RPRPRPR", nullptr, nullptr}, /* the seven chains of the paper */
    {"PRPRP", nullptr, nullptr},
    {"PRPRPRP", nullptr, nullptr},
    {"RRRRR", nullptr, nullptr},
    {"RRRR", nullptr, nullptr},
    {"PRRRRP", nullptr, nullptr},
    {"PRRP", nullptr, nullptr},
    {"scissors", nullptr, "scissors.grrl"},
    {"wooden-toy", nullptr, "wooden-toy.grrl"},
    {"star", "R(l1, l2, l3, l4)", nullptr}, /* three arms on l1 */
    {"loop-4R", "R(l1, R(l4, R(l3, R(l2, l1))))", nullptr},
    {"loop-5R", "R(l1, R(l5, R(l4, R(l3, R(l2, l1)))))", nullptr},
    {"slider-crank", "P(l1, R(l4, R(l3, R(l2, l1))))", nullptr},
    {"two-objects", "D(R(R(l1, l2), l3), P(l4, l5))", nullptr},
};

/* The installed file, or that of the source tree. */
Result<ObjectSpec> object_of_file(const char *name)
{
    for (const char *folder : {GRRL_OBJECTS_INSTALLED, GRRL_OBJECTS_SOURCE}) {
        std::string path = std::string(folder) + "/" + name;
        if (std::FILE *file = std::fopen(path.c_str(), "r")) {
            (void)std::fclose(file);
            return grrl_sim::object_from_text(path);
        }
    }
    return Result<ObjectSpec>::bad(std::string(name) + " is not in " GRRL_OBJECTS_INSTALLED
                                                       "; use its path instead of its name");
}

Result<ObjectSpec> object_of_name(const std::string &name)
{
    for (const Entry &entry : entries) {
        if (name != entry.name)
            continue;
        if (entry.file != nullptr)
            return object_of_file(entry.file);
        return grrl_sim::object_from_text(entry.text != nullptr ? entry.text : entry.name);
    }
    return grrl_sim::object_from_text(name);
}

std::string trim(const std::string &text)
{
    size_t first = text.find_first_not_of(" \t\n");
    size_t last = text.find_last_not_of(" \t\n");
    return first == std::string::npos ? std::string() : text.substr(first, last - first + 1);
}

std::vector<std::string> split(const std::string &names)
{
    std::vector<std::string> parts;
    size_t begin = 0;
    while (begin <= names.size()) {
        size_t end = std::min(names.find(';', begin), names.size());
        std::string part = trim(names.substr(begin, end - begin));
        if (!part.empty())
            parts.push_back(part);
        begin = end + 1;
    }
    return parts;
}

} // namespace

std::string object_names()
{
    std::string names;
    for (const Entry &entry : entries)
        names += (names.empty() ? "" : "; ") + std::string(entry.name);
    return names;
}

Result<std::vector<NamedObject>> select_objects(const std::string &names)
{
    std::vector<NamedObject> objects;
    for (const std::string &name : split(names.empty() ? object_names() : names)) {
        Result<ObjectSpec> spec = object_of_name(name);
        if (!spec) {
            bool says_which = spec.error.compare(0, name.size(), name) == 0;
            return Result<std::vector<NamedObject>>::bad((says_which ? "" : name + ": ") +
                                                         spec.error);
        }
        objects.push_back({name, *spec.value});
    }
    if (objects.empty())
        return Result<std::vector<NamedObject>>::bad("no object is named");
    return Result<std::vector<NamedObject>>::good(std::move(objects));
}

} // namespace grrl_experiment::perception
