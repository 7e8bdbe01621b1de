/*
 * world.cpp: the simulated world in this process, and apart from it the supervisor, who knows the
 * truth.
 */
#include "native.hpp"

#include <algorithm>
#include <set>
#include <tuple>

#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include "adapter.hpp"
#include "random.hpp"
#include "supervisor.hpp"
#include "world.hpp"

namespace grrl_python
{

namespace
{

/* Python's picture of a world: nothing of it tells the truth. */
class PyWorld
{
public:
    PyWorld(const grrl_sim::ObjectSpec &object, const grrl_sim::WorldParams &params, uint64_t seed)
        : world(object, params, seed)
    {
    }

    grrl_sim::World world;

    std::unique_ptr<Frame> observe()
    {
        world.observe(frame_);
        auto frame = std::make_unique<Frame>();
        size_t n = std::min(frame_.features.size(), size_t{GRRL_MAX_FEATURES});
        frame->id.resize(n);
        frame->x_m.resize(n);
        frame->y_m.resize(n);
        (void)grrl_sim::copy_points(frame_, static_cast<int>(n), frame->id.data(),
                                    frame->x_m.data(), frame->y_m.data());
        frame->time_s = frame_.time_s;
        return frame;
    }

private:
    grrl_sim::Frame frame_;
};

grrl_sim::ObjectSpec object_of(const std::string &text)
{
    auto object = grrl_sim::object_from_text(text);
    if (!object)
        throw nb::value_error(object.error.c_str());
    return *object.value;
}

/* The structure to be found: the truth without what is glued to the table and never seen; as
 * visible_structure of grrl-sim. */
grrl_graph visible(const grrl_sim::ObjectSpec &object)
{
    grrl_graph graph;
    grrl_graph_clear(&graph);
    std::vector<int> vertex(object.links.size(), -1);
    for (size_t i = 0; i < object.links.size(); i++) {
        uint8_t index = 0;
        if (!object.links[i].fixed &&
            grrl_graph_add_link(&graph, object.truth.label[i], &index) == GRRL_OK)
            vertex[i] = index;
    }
    for (const grrl_sim::JointSpec &joint : object.joints) {
        int a = vertex[static_cast<size_t>(joint.a)];
        int b = vertex[static_cast<size_t>(joint.b)];
        if (a >= 0 && b >= 0)
            must(grrl_graph_add_joint(&graph, static_cast<uint8_t>(a), static_cast<uint8_t>(b),
                                      joint.type),
                 "the object");
    }
    return graph;
}

using Point = std::tuple<double, double>;

/* Why not, or an empty text. */
std::string begin_push(PyWorld &self, Point start, Point end, double travel, double speed,
                       double force, double timeout)
{
    /* Through the library's struct, as a decision comes: in single precision. */
    auto f = [](double x) { return static_cast<float>(x); };
    grrl_push push{{f(std::get<0>(start)), f(std::get<1>(start))},
                   {f(std::get<0>(end)), f(std::get<1>(end))},
                   f(travel),
                   f(speed),
                   f(force),
                   f(timeout)};
    return self.world.begin_push(grrl_sim::command_of(push));
}

nb::tuple push_result(const PyWorld &self)
{
    const grrl_sim::PushResult &result = self.world.push_result();
    return nb::make_tuple(grrl_sim::push_reason_text(result.reason), result.touched,
                          result.duration_s, result.travelled_m,
                          nb::make_tuple(result.from_m.x, result.from_m.y),
                          nb::make_tuple(result.to_m.x, result.to_m.y));
}

/* --- the truth -------------------------------------------------------------------------------- */

class Supervisor
{
public:
    explicit Supervisor(const std::string &text)
        : object_(object_of(text)), graph_(visible(object_)), supervisor_(graph_)
    {
    }

    /* ends: of the joints, then their types */
    nb::tuple judge(int links, const std::vector<std::tuple<int, int, int>> &joints) const
    {
        grrl_graph believed;
        grrl_graph_clear(&believed);
        for (int i = 0; i < links; i++)
            must(grrl_graph_add_link(&believed, 0, nullptr), "judge");
        for (auto [a, b, type] : joints) {
            if (a < 0 || b < 0 || a >= links || b >= links || type < 0 || type >= GRRL_JOINT_TYPES)
                throw nb::value_error("judge: a joint of a link that is not there");
            must(grrl_graph_add_joint(&believed, static_cast<uint8_t>(a), static_cast<uint8_t>(b),
                                      static_cast<grrl_joint_type>(type)),
                 "judge");
        }
        return tuple_of(supervisor_.judge(believed));
    }

    nb::tuple judge_learner(const Learner &learner) const
    {
        grrl_graph believed;
        grrl_relational_state_of(&learner.native_model(), learner.large_m(), &believed, nullptr,
                                 nullptr);
        return tuple_of(supervisor_.judge(believed));
    }

    int links() const { return graph_.n; }

    nb::list joints() const
    {
        nb::list list;
        for (int a = 0; a < graph_.n; a++)
            for (int b = a + 1; b < graph_.n; b++) {
                int type =
                    grrl_graph_joint(&graph_, static_cast<uint8_t>(a), static_cast<uint8_t>(b));
                if (type != GRRL_NO_JOINT)
                    list.append(nb::make_tuple(a, b, type));
            }
        return list;
    }

private:
    static nb::tuple tuple_of(const grrl_sim::Verdict &verdict)
    {
        return nb::make_tuple(verdict.correct, verdict.undecided, verdict.missing_links,
                              verdict.missing_revolute, verdict.missing_prismatic,
                              grrl_sim::verdict_text(verdict));
    }

    grrl_sim::ObjectSpec object_;
    grrl_graph graph_;
    grrl_sim::Supervisor supervisor_;
};

nb::ndarray<nb::numpy, double> true_poses(const PyWorld &self)
{
    std::vector<double> values;
    std::vector<grrl_sim::Pose> poses = self.world.true_poses();
    for (const grrl_sim::Pose &pose : poses)
        values.insert(values.end(), {pose.position.x, pose.position.y, pose.angle});
    return array_of(std::move(values), {poses.size(), 3});
}

nb::ndarray<nb::numpy, double> true_joint_values(const PyWorld &self)
{
    std::vector<double> values;
    size_t n = self.world.object().joints.size();
    for (size_t j = 0; j < n; j++)
        values.push_back(self.world.true_joint_value(static_cast<int>(j)));
    return array_of(std::move(values), {n});
}

nb::ndarray<nb::numpy, int32_t> true_link_of_point(const PyWorld &self)
{
    std::vector<int32_t> links;
    for (int id = 0; id < self.world.tracker().feature_count(); id++)
        links.push_back(self.world.tracker().true_link(static_cast<uint32_t>(id)));
    size_t n = links.size();
    return array_of(std::move(links), {n});
}

nb::ndarray<nb::numpy, double> true_sizes(const PyWorld &self)
{
    std::vector<double> values;
    for (const grrl_sim::LinkSpec &link : self.world.object().links)
        values.insert(values.end(), {2.0 * link.half_length_m, 2.0 * link.half_width_m});
    return array_of(std::move(values), {self.world.object().links.size(), 2});
}

/* Of each true link the body that holds most of its features, -1: none; as grrl-experiment has it.
 */
std::vector<int> bodies_of_links(const grrl_sim::World &world, const grrl_model &model)
{
    size_t n = world.object().links.size();
    std::vector<std::vector<int>> held(n, std::vector<int>(model.n_bodies, 0));
    for (int i = 0; i < model.n_features; i++) {
        int32_t id = model.feature_id[i];
        bool known = id >= 0 && id < world.tracker().feature_count() &&
                     model.feature_body[i] < model.n_bodies;
        int of = known ? world.tracker().true_link(static_cast<uint32_t>(id)) : -1;
        if (of >= 0)
            held[static_cast<size_t>(of)][model.feature_body[i]]++;
    }
    std::vector<int> bodies;
    for (const std::vector<int> &counts : held) {
        auto best = std::max_element(counts.begin(), counts.end());
        bool any = best != counts.end() && *best > 0;
        bodies.push_back(any ? static_cast<int>(best - counts.begin()) : -1);
    }
    return bodies;
}

bool agree(const grrl_sim::JointSpec &truth, const grrl_joint &joint,
           const std::vector<int> &bodies)
{
    int a = bodies[static_cast<size_t>(truth.a)];
    int b = bodies[static_cast<size_t>(truth.b)];
    bool ends = (a == joint.a && b == joint.b) || (a == joint.b && b == joint.a);
    return ends && a != b && static_cast<int>(truth.type) == joint.type;
}

/* Believed joints that the object has not: the numbers of their bodies and their type. */
nb::list wrong_joints(const PyWorld &self, const Learner &learner)
{
    const grrl_model &model = learner.native_model();
    std::vector<int> bodies = bodies_of_links(self.world, model);
    const auto &truth = self.world.object().joints;
    nb::list wrong;
    for (int i = 0; i < model.n_joints; i++) {
        const grrl_joint &joint = model.joint[i];
        if (std::any_of(truth.begin(), truth.end(), [&](const grrl_sim::JointSpec &spec) {
                return agree(spec, joint, bodies);
            }))
            continue;
        auto ends = std::minmax(model.body[joint.a].number, model.body[joint.b].number);
        wrong.append(nb::make_tuple(static_cast<int>(ends.first), static_cast<int>(ends.second),
                                    static_cast<int>(joint.type)));
    }
    return wrong;
}

std::unique_ptr<PyWorld> make_world(const std::string &object, uint64_t seed, double noise_m,
                                    double dropout, double outliers)
{
    grrl_sim::WorldParams params;
    params.tracker.noise_sigma_m = noise_m;
    params.tracker.dropout_probability = dropout;
    params.tracker.outlier_probability = outliers;
    std::string wrong = grrl_sim::check_world(params);
    if (!wrong.empty())
        throw nb::value_error(wrong.c_str());
    return std::make_unique<PyWorld>(object_of(object), params, seed);
}

} // namespace

void bind_world(nb::module_ &m)
{
    nb::class_<PyWorld>(m, "World")
        .def(nb::new_(&make_world), nb::arg("object"), nb::arg("seed"), nb::arg("noise_m"),
             nb::arg("dropout"), nb::arg("outliers"))
        .def("begin_push", &begin_push, nb::arg("start"), nb::arg("end"), nb::arg("travel"),
             nb::arg("speed"), nb::arg("force"), nb::arg("timeout"))
        .def("step", [](PyWorld &self) { return self.world.step_frame(); })
        .def("observe", &PyWorld::observe)
        .def("push_result", &push_result)
        .def("time_s", [](const PyWorld &self) { return self.world.time_s(); })
        .def("state_hash", [](const PyWorld &self) { return self.world.state_hash(); });
    nb::class_<Supervisor>(m, "Supervisor")
        .def(nb::init<const std::string &>(), nb::arg("object"))
        .def("judge", &Supervisor::judge, nb::arg("links"), nb::arg("joints"))
        .def("judge_learner", &Supervisor::judge_learner, nb::arg("learner"))
        .def("links", &Supervisor::links)
        .def("joints", &Supervisor::joints);
    m.def("set_object_folder", &set_object_folder, nb::arg("path"));
    m.def("trial_seed", &grrl_sim::trial_seed, nb::arg("seed"), nb::arg("trial"));
    m.def("true_poses", &true_poses, nb::arg("world"));
    m.def("true_joint_values", &true_joint_values, nb::arg("world"));
    m.def("true_link_of_point", &true_link_of_point, nb::arg("world"));
    m.def("true_sizes", &true_sizes, nb::arg("world"));
    m.def("wrong_joints", &wrong_joints, nb::arg("world"), nb::arg("learner"));
}

} // namespace grrl_python
