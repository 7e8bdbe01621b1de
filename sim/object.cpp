/* Objects from chains and terms, with the default dimensions. */
#include "object.hpp"

#include <algorithm>
#include <cstring>

#include "grrl/structure/term.h"
#include "kinematics.hpp"
#include "object_file.hpp"
#include "object_folder.hpp"

namespace grrl_sim
{

namespace
{

constexpr uint16_t term_capacity = 1024;

std::string at_position(const TermPosition &position, const std::string &message)
{
    return std::to_string(position.line) + ":" + std::to_string(position.column) + ": " + message;
}

/* Whether a name has the form l1, f1 or v1. */
bool is_numbered(const std::string &name)
{
    return name.size() > 1 && std::string("lfv").find(name[0]) != std::string::npos &&
           name.find_first_not_of("0123456789", 1) == std::string::npos;
}

/* Reads a bare word as a term. Most such words are incomplete names of files or
 * objects, not links. */
Result<ObjectSpec> object_from_word(const std::string &text, const ObjectScale &scale)
{
    std::string path = object_path(text);
    if (!path.empty())
        return object_from_file(path, scale);
    Result<ObjectSpec> object = object_from_term(text, scale);
    if (object && object.value->links.size() == 1 && !is_numbered(object.value->links[0].name))
        object = Result<ObjectSpec>::bad("write a single link of this name as L(" + text + ")");
    if (!object)
        object.error =
            "'" + text +
            "' is not a chain such as RPR, not a file such as scissors.grrl, and as a term: " +
            object.error;
    std::string names = object_names();
    if (!object && !names.empty())
        object.error += "; by name there are " + names;
    return object;
}

} // namespace

LinkSpec default_link(grrl_property size)
{
    LinkSpec link;
    link.size = size;
    if (size == GRRL_PROPERTY_SMALL)
        link.half_length_m = small_half_length_m;
    else if (size == GRRL_PROPERTY_LARGE)
        link.half_length_m = large_half_length_m;
    link.mass_kg *=
        link.half_length_m / LinkSpec{}.half_length_m; /* as if all links were cut from one bar */
    set_feature_range(link);
    return link;
}

void set_feature_range(LinkSpec &link)
{
    constexpr int fewest = 6;
    const LinkSpec standard;
    double area =
        link.half_length_m * link.half_width_m / (standard.half_length_m * standard.half_width_m);
    link.features_min = std::clamp(static_cast<int>(8.0 * area + 0.5), fewest, 24);
    link.features_max = std::clamp(static_cast<int>(14.0 * area + 0.5), fewest + 4, 36);
}

void resize_link(LinkSpec &link, double length, double width)
{
    link.half_length_m *= length;
    link.half_width_m *= width;
    link.mass_kg *= length * width;
    set_feature_range(link);
}

JointSpec default_joint(grrl_joint_type type, int a, int b)
{
    bool turns = type == GRRL_REVOLUTE;
    JointSpec joint;
    joint.type = type;
    joint.a = a;
    joint.b = b;
    joint.upper = turns ? revolute_limit_rad : prismatic_limit_m;
    joint.lower = -joint.upper;
    joint.friction = turns ? revolute_friction_n_m : prismatic_friction_n;
    joint.initial_upper = turns ? revolute_initial_rad : prismatic_initial_m;
    joint.initial_lower = -joint.initial_upper;
    return joint;
}

Result<ObjectSpec> object_from_chain(const std::string &letters, const ObjectScale &scale)
{
    ObjectSpec object;
    grrl_graph_clear(&object.truth);
    if (letters.empty())
        return Result<ObjectSpec>::bad(
            "the chain is empty; write one letter R or P for each joint");
    for (size_t i = 0; i < letters.size(); i++) {
        if (letters[i] != 'R' && letters[i] != 'P')
            return Result<ObjectSpec>::bad(
                at_position({1, static_cast<unsigned>(i + 1)},
                            std::string("a chain cannot contain '") + letters[i] +
                                "'; R is a revolute and P a prismatic joint, such as RPRPRPR"));
    }
    if (letters.size() + 1 > GRRL_MAX_LINKS)
        return Result<ObjectSpec>::bad("a chain of " + std::to_string(letters.size()) +
                                       " joints has " + std::to_string(letters.size() + 1) +
                                       " links; this build holds at most " +
                                       std::to_string(GRRL_MAX_LINKS) + " (GRRL_MAX_LINKS)");
    for (size_t i = 0; i <= letters.size(); i++) {
        uint8_t index = 0;
        if (grrl_graph_add_link(&object.truth, 0, &index) != GRRL_OK)
            return Result<ObjectSpec>::bad("the graph of the chain is full");
        object.links.push_back(default_link(0));
        object.links.back().name = "l" + std::to_string(i + 1);
    }
    for (size_t i = 0; i < letters.size(); i++) {
        grrl_joint_type type = letters[i] == 'R' ? GRRL_REVOLUTE : GRRL_PRISMATIC;
        int a = static_cast<int>(i);
        if (grrl_graph_add_joint(&object.truth, static_cast<uint8_t>(a),
                                 static_cast<uint8_t>(a + 1), type) != GRRL_OK)
            return Result<ObjectSpec>::bad("the graph of the chain is full");
        object.joints.push_back(default_joint(type, a, a + 1));
    }
    std::string problem = finish_object(object, scale);
    return problem.empty() ? Result<ObjectSpec>::good(object) : Result<ObjectSpec>::bad(problem);
}

Result<ObjectSpec> links_and_joints(const std::string &text, TermPosition *error_position)
{
    std::vector<struct grrl_term_node> nodes(term_capacity);
    grrl_term_store store;
    grrl_term_store_init(&store, nodes.data(), term_capacity);
    grrl_term term = 0;
    grrl_term_error error;
    std::memset(&error, 0, sizeof error);
    ObjectSpec object;
    grrl_name names[GRRL_MAX_LINKS];
    grrl_edge edges[GRRL_MAX_JOINTS];
    uint8_t n_edges = 0;
    grrl_status status = grrl_term_parse(&store, text.data(), text.size(), &term, &error);
    if (status == GRRL_OK)
        status = grrl_graph_from_term(&store, term, &object.truth, names, edges, &n_edges, &error);
    if (status != GRRL_OK) {
        *error_position = {std::max(error.line, 1u), std::max(error.column, 1u)};
        return Result<ObjectSpec>::bad(error.message[0] != '\0' ? error.message
                                                                : grrl_status_text(status));
    }
    for (int i = 0; i < object.truth.n; i++) {
        LinkSpec link = default_link(static_cast<grrl_property>(object.truth.label[i] & 0xff));
        char name[GRRL_NAME_BYTES];
        link.name = grrl_term_name_text(&store, names[i], name);
        link.fixed = names[i].kind == GRRL_NAME_BACKGROUND;
        object.links.push_back(link);
    }
    for (int j = 0; j < n_edges; j++)
        object.joints.push_back(
            default_joint(static_cast<grrl_joint_type>(edges[j].type), edges[j].a, edges[j].b));
    return Result<ObjectSpec>::good(object);
}

Result<ObjectSpec> object_from_term(const std::string &text, const ObjectScale &scale)
{
    TermPosition position;
    Result<ObjectSpec> object = links_and_joints(text, &position);
    if (!object)
        return Result<ObjectSpec>::bad(at_position(position, object.error));
    std::string problem = finish_object(*object.value, scale);
    return problem.empty() ? object : Result<ObjectSpec>::bad(problem);
}

Result<ObjectSpec> object_from_text(const std::string &text, const ObjectScale &scale)
{
    bool relational = text.find_first_of("(&") != std::string::npos;
    bool path = text.find_first_of("./\\") != std::string::npos;
    bool capitals =
        !text.empty() && text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ") == std::string::npos;
    if (relational)
        return object_from_term(text, scale);
    if (path)
        return object_from_file(text, scale);
    if (capitals || text.empty())
        return object_from_chain(text, scale);
    return object_from_word(text, scale);
}

} // namespace grrl_sim
