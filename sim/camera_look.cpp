/* The appearance of the camera images as text. */
#include "camera.hpp"

#include <cstdlib>
#include <sstream>

namespace grrl_sim
{

namespace
{

struct Entry {
    const char *name;
    double low;
    double high;
    double CameraLook::*real; /* one of these two */
    int CameraLook::*whole;
    const char *help;
};

const Entry entries[] = {
    {"width", 160, 1920, nullptr, &CameraLook::width_px, "pixels"},
    {"height", 160, 1920, nullptr, &CameraLook::height_px, "pixels"},
    {"scale", 0.5, 10, &CameraLook::mm_per_px, nullptr, "millimetres per pixel"},
    {"noise", 0, 30, &CameraLook::noise, nullptr, "of a pixel, grey levels"},
    {"blur", 0, 5, &CameraLook::blur_px, nullptr, "of the lens, pixels"},
    {"gradient", 0, 0.9, &CameraLook::gradient, nullptr, "light missing in the darkest corner"},
    {"shadow", 0, 0.9, &CameraLook::shadow, nullptr, "light missing in a shadow"},
    {"distortion", -0.2, 0.2, &CameraLook::distortion, nullptr, "of the lens, at half the width"},
    {"table", 0, 60, &CameraLook::table_texture, nullptr, "pattern of the table, grey levels"},
    {"links", 0, 60, &CameraLook::link_texture, nullptr, "pattern of the links, grey levels"},
    {"brightness", 0, 2, &CameraLook::brightness, nullptr, "of everything"},
};

/* Like parse_camera_look, for one of them. */
std::string parse_entry(const std::string &item, CameraLook &look)
{
    size_t equals = item.find('=');
    std::string name = item.substr(0, equals);
    for (const Entry &entry : entries) {
        if (name != entry.name)
            continue;
        const char *text = equals == std::string::npos ? "" : item.c_str() + equals + 1;
        char *end;
        double value = std::strtod(text, &end);
        bool whole = entry.real == nullptr;
        bool good = end != text && *end == '\0' && value >= entry.low && value <= entry.high;
        if (!good || (whole && (value != static_cast<int>(value) || static_cast<int>(value) % 2))) {
            std::ostringstream message;
            message << (whole ? "an even" : "a") << " number from " << entry.low << " to "
                    << entry.high << " for " << name << ", as in " << name << "="
                    << (whole ? 480.0 : entry.high / 2.0);
            return message.str();
        }
        if (whole)
            look.*entry.whole = static_cast<int>(value);
        else
            look.*entry.real = value;
        return {};
    }
    std::string names;
    for (const Entry &entry : entries)
        names += std::string(names.empty() ? "" : ", ") + entry.name;
    return "NAME=X, separated by commas, with a NAME out of " + names;
}

} // namespace

std::string parse_camera_look(const std::string &text, CameraLook &look)
{
    CameraLook parsed = look;
    std::stringstream items(text);
    std::string item;
    while (std::getline(items, item, ',')) {
        std::string problem = parse_entry(item, parsed);
        if (!problem.empty())
            return problem;
    }
    look = parsed;
    return {};
}

std::string camera_look_help()
{
    std::ostringstream help;
    for (const Entry &entry : entries) {
        CameraLook standard;
        help << "  " << entry.name << "=" << entry.low << " .. " << entry.high << "  " << entry.help
             << " (";
        if (entry.real != nullptr)
            help << standard.*entry.real;
        else
            help << standard.*entry.whole;
        help << ")\n";
    }
    return help.str();
}

Vec2 camera_view_m(const CameraLook &look)
{
    return {0.001 * look.mm_per_px * look.width_px, 0.001 * look.mm_per_px * look.height_px};
}

} // namespace grrl_sim
