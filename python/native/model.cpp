/* model.cpp: what perception believes, as a dictionary of arrays. */
#include "native.hpp"

#include <tuple>

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

extern "C" {
#include "report.h"
}

namespace grrl_python
{

namespace
{

constexpr uint16_t term_nodes = 4 * GRRL_MAX_LINKS + 8 * GRRL_MAX_JOINTS + 8;
constexpr size_t term_bytes = size_t{32} * term_nodes;

void add_bodies(nb::dict &dict, const grrl_model &model, double per_metre)
{
    std::vector<int32_t> number;
    std::vector<double> centroid, axis, size;
    for (int i = 0; i < model.n_bodies; i++) {
        const grrl_body &body = model.body[i];
        number.push_back(body.number);
        for (float at : {body.centroid_m.x, body.centroid_m.y})
            centroid.push_back(static_cast<double>(at) * per_metre);
        for (float part : {body.axis.x, body.axis.y})
            axis.push_back(static_cast<double>(part));
        for (float extent : {body.length_m, body.width_m})
            size.push_back(static_cast<double>(extent) * per_metre);
    }
    size_t n = number.size();
    dict["body_number"] = array_of(std::move(number), {n});
    dict["body_centroid"] = array_of(std::move(centroid), {n, 2});
    dict["body_axis"] = array_of(std::move(axis), {n, 2});
    dict["body_size"] = array_of(std::move(size), {n, 2});
}

void add_joints(nb::dict &dict, const grrl_model &model, double per_metre)
{
    std::vector<int32_t> ends, type;
    std::vector<double> p, point, covariance, axis, axis_sd, range;
    for (int i = 0; i < model.n_joints; i++) {
        const grrl_joint &joint = model.joint[i];
        double to_unit = joint.type == GRRL_PRISMATIC ? per_metre : 1.0;
        ends.insert(ends.end(), {joint.a, joint.b});
        type.push_back(joint.type);
        for (float x :
             {joint.probability, joint.p_revolute, joint.p_prismatic, joint.p_disconnected})
            p.push_back(static_cast<double>(x));
        for (float at : {joint.point_m.x, joint.point_m.y})
            point.push_back(static_cast<double>(at) * per_metre);
        for (int k : {0, 1, 1, 2})
            covariance.push_back(static_cast<double>(joint.point_cov_m2[k]) * per_metre *
                                 per_metre);
        for (float part : {joint.axis.x, joint.axis.y})
            axis.push_back(static_cast<double>(part));
        axis_sd.push_back(static_cast<double>(joint.axis_sd_rad));
        for (float limit : {joint.lower, joint.upper})
            range.push_back(static_cast<double>(limit) * to_unit);
    }
    size_t n = type.size();
    dict["joint_ends"] = array_of(std::move(ends), {n, 2});
    dict["joint_type"] = array_of(std::move(type), {n});
    dict["joint_p"] = array_of(std::move(p), {n, 4});
    dict["joint_point"] = array_of(std::move(point), {n, 2});
    dict["joint_covariance"] = array_of(std::move(covariance), {n, 2, 2});
    dict["joint_axis"] = array_of(std::move(axis), {n, 2});
    dict["joint_axis_sd"] = array_of(std::move(axis_sd), {n});
    dict["joint_range"] = array_of(std::move(range), {n, 2});
}

/* Those that no joint ties. */
void add_pairs(nb::dict &dict, const grrl_report &report)
{
    const grrl_model &model = *report.model;
    std::vector<int32_t> ends, relation;
    std::vector<double> p;
    nb::list reason;
    for (int a = 0; a < model.n_bodies; a++) {
        for (int b = a + 1; b < model.n_bodies; b++) {
            grrl_pair pair{};
            (void)grrl_report_relation(&report, static_cast<unsigned>(a), static_cast<unsigned>(b),
                                       &pair);
            if (pair.relation == GRRL_RELATION_JOINED)
                continue;
            ends.insert(ends.end(), {a, b});
            relation.push_back(pair.relation);
            reason.append(grrl_report_reason(&report, &pair).text);
            for (float x : {pair.p_revolute, pair.p_prismatic, pair.p_disconnected})
                p.push_back(static_cast<double>(x));
        }
    }
    size_t n = relation.size();
    dict["pair_ends"] = array_of(std::move(ends), {n, 2});
    dict["pair_relation"] = array_of(std::move(relation), {n});
    dict["pair_reason"] = reason;
    dict["pair_p"] = array_of(std::move(p), {n, 3});
}

void add_features(nb::dict &dict, const grrl_model &model, double per_metre)
{
    std::vector<int32_t> id, of;
    std::vector<double> at;
    for (int i = 0; i < model.n_features; i++) {
        id.push_back(model.feature_id[i]);
        of.push_back(model.feature_body[i] == GRRL_FEATURE_BACKGROUND ? -1
                     : model.feature_body[i] == GRRL_FEATURE_NONE     ? -2
                                                                      : model.feature_body[i]);
        for (float x : {model.feature_m[i].x, model.feature_m[i].y})
            at.push_back(static_cast<double>(x) * per_metre);
    }
    size_t n = id.size();
    dict["feature_id"] = array_of(std::move(id), {n});
    dict["feature_body"] = array_of(std::move(of), {n});
    dict["feature_at"] = array_of(std::move(at), {n, 2});
}

/* The direction frames of a link, in the world: what 0 and 90 degrees mean for each body. */
void add_frames(nb::dict &dict, const grrl_model &model)
{
    std::vector<double> frames;
    for (int i = 0; i < model.n_bodies; i++) {
        grrl_link_frame frame{};
        (void)!grrl_grounding_frame(&model, static_cast<uint8_t>(i), &frame);
        for (float x : {frame.forward.x, frame.forward.y, frame.side.x, frame.side.y})
            frames.push_back(static_cast<double>(x));
    }
    dict["body_frame"] = array_of(std::move(frames), {model.n_bodies, size_t{2}, size_t{2}});
}

/* The term of links and joints that came in a message, each joint as (a, b, type). */
std::string term_of_structure(const std::vector<int> &numbers, const std::vector<bool> &large,
                              const std::vector<std::tuple<int, int, int>> &joints)
{
    auto model = std::make_unique<grrl_model>();
    int n = static_cast<int>(numbers.size());
    if (n > GRRL_MAX_LINKS || large.size() != numbers.size() || joints.size() > GRRL_MAX_JOINTS)
        throw nb::value_error("term_of_structure: more links or joints than this build knows");
    for (int number : numbers) {
        grrl_body &body = model->body[model->n_bodies];
        body.number = static_cast<uint16_t>(number);
        body.length_m = large[model->n_bodies++] ? 1.0f : 0.0f;
    }
    for (auto [a, b, type] : joints) {
        if (a < 0 || b < 0 || a >= n || b >= n || a == b || type < 0 || type >= GRRL_JOINT_TYPES)
            throw nb::value_error("term_of_structure: a joint of a link that is not there");
        grrl_joint &joint = model->joint[model->n_joints++];
        joint.a = static_cast<uint8_t>(a);
        joint.b = static_cast<uint8_t>(b);
        joint.type = static_cast<uint8_t>(type);
    }
    return term_of(*model, 0.5f);
}

} // namespace

std::string term_of(const grrl_model &model, float large_m)
{
    std::vector<grrl_term_node> nodes(term_nodes);
    std::vector<char> text(term_bytes);
    auto store = std::make_unique<grrl_term_store>();
    grrl_term term;
    grrl_term_store_init(store.get(), nodes.data(), term_nodes);
    must(grrl_relational_term_of(&model, large_m, store.get(), &term), "the term of the model");
    must(grrl_term_print(store.get(), term, text.size(), text.data(), nullptr),
         "the term of the model");
    return text.data();
}

nb::dict model_dict(const grrl_perception &perception, const grrl_model &model, float large_m,
                    double per_metre, const char *unit)
{
    grrl_report report{};
    report.model = &model;
    report.perception = &perception;
    report.unit = unit;
    report.per_metre = per_metre;
    nb::dict dict;
    dict["term"] = term_of(model, large_m);
    add_bodies(dict, model, per_metre);
    add_frames(dict, model);
    add_joints(dict, model, per_metre);
    add_pairs(dict, report);
    add_features(dict, model, per_metre);
    return dict;
}

void must(grrl_status status, const char *what)
{
    if (status == GRRL_OK)
        return;
    std::string text = std::string(what) + ": " + grrl_status_text(status);
    if (status == GRRL_ERR_ORDER || status == GRRL_ERR_UNDECIDED || status == GRRL_ERR_IO)
        throw std::runtime_error(text);
    throw nb::value_error(text.c_str());
}

Frame frame_from(const Ids &id, const Floats &x_m, const Floats &y_m)
{
    size_t n = id.shape(0);
    if (x_m.shape(0) != n || y_m.shape(0) != n)
        throw nb::value_error("ids, x and y must have one length");
    return {{id.data(), id.data() + n}, {x_m.data(), x_m.data() + n}, {y_m.data(), y_m.data() + n}};
}

grrl_perception_config profile_config(const std::string &profile, double noise, double metres)
{
    grrl_perception_config config;
    if (profile == "camera")
        grrl_perception_config_camera(&config, static_cast<float>(metres));
    else
        grrl_perception_config_default(&config);
    if (noise > 0.0)
        config.noise_m = static_cast<float>(noise) * static_cast<float>(metres);
    return config;
}

void bind_model(nb::module_ &m)
{
    nb::class_<Frame>(m, "Frame", "The points that are visible at one time, in metres.")
        .def(nb::new_([](const Ids &id, const Floats &x_m, const Floats &y_m) {
                 return std::make_unique<Frame>(frame_from(id, x_m, y_m));
             }),
             nb::arg("ids"), nb::arg("x"), nb::arg("y"))
        .def("__len__", [](const Frame &frame) { return frame.id.size(); })
        .def_prop_ro(
            "ids", [](const Frame &frame) { return array_of(frame.id, {frame.id.size()}); },
            nb::rv_policy::automatic, "(n,) int32: the number of each point, in ascending order.")
        .def_prop_ro(
            "points",
            [](const Frame &frame) {
                std::vector<double> at;
                for (size_t i = 0; i < frame.id.size(); i++)
                    for (float x : {frame.x_m[i], frame.y_m[i]})
                        at.push_back(static_cast<double>(x));
                return array_of(std::move(at), {frame.id.size(), 2});
            },
            nb::rv_policy::automatic, "(n, 2) float64: positions, metres.")
        .def_ro("time_s", &Frame::time_s, "Seconds since the world began.");
    m.def("term_of_structure", &term_of_structure, nb::arg("numbers"), nb::arg("large"),
          nb::arg("joints"));
}

} // namespace grrl_python
