/*
 * native.hpp: what the parts of the extension module share.
 *
 * The module is thin: it takes flat arrays and gives dictionaries of arrays. The classes that
 * people see, their documentation and most checks are in Python.
 */
#ifndef GRRL_PYTHON_NATIVE_HPP
#define GRRL_PYTHON_NATIVE_HPP

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/unique_ptr.h>

#include "grrl/grrl.h"

namespace grrl_python
{

namespace nb = nanobind;

using Ids = nb::ndarray<const int32_t, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Floats = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;
using Flags = nb::ndarray<const bool, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/* The points of one time, as the library takes them. */
struct Frame {
    std::vector<int32_t> id;
    std::vector<float> x_m;
    std::vector<float> y_m;
    double time_s = 0.0;

    grrl_frame view() const
    {
        return {static_cast<uint32_t>(id.size()), id.data(), x_m.data(), y_m.data()};
    }
};

/* ValueError unless the three arrays have one length. */
Frame frame_from(const Ids &id, const Floats &x_m, const Floats &y_m);

/* A NumPy array that owns a vector's values; their number is the product of the shape. */
template <typename T>
nb::ndarray<nb::numpy, T> array_of(std::vector<T> values, std::vector<size_t> shape)
{
    auto *owned = new std::vector<T>(std::move(values));
    nb::capsule owner(owned, [](void *p) noexcept { delete static_cast<std::vector<T> *>(p); });
    return nb::ndarray<nb::numpy, T>(owned->data(), shape.size(), shape.data(), owner);
}

/* The term of a model. */
std::string term_of(const grrl_model &model, float large_m);

/* Everything perception believes as a dictionary of arrays; lengths times per_metre, in unit. */
nb::dict model_dict(const grrl_perception &perception, const grrl_model &model, float large_m,
                    double per_metre = 1.0, const char *unit = "m");

/* RuntimeError or ValueError for a status that is not GRRL_OK. */
void must(grrl_status status, const char *what);

/* The configuration of a profile, "tracker" or "camera"; noise in units, 0: the profile's. */
grrl_perception_config profile_config(const std::string &profile, double noise, double metres);

/* The random numbers of a policy, passed by value: what is kept of it does no harm. */
struct PolicyRandom {
    grrl_random state;
};

/* A policy of Python behind the library's interface. */
class OwnPolicy
{
public:
    explicit OwnPolicy(nb::object adapter);
    OwnPolicy(const OwnPolicy &) = delete;
    OwnPolicy &operator=(const OwnPolicy &) = delete;

    grrl_policy policy() { return {&type_, this}; }
    const nb::object &adapter() const { return adapter_; }
    nb::object &adapter() { return adapter_; }

    /* Throws what the adapter raised in the last call, if it did. */
    void rethrow();

private:
    static void begin_trial(void *self);
    static void choose(void *self, const grrl_view *view, grrl_random *random, grrl_choice *choice);
    static void explain(void *self, const grrl_view *view, grrl_choice *choice);
    static void learn(void *self, const grrl_outcome *outcome, grrl_update *update);
    template <typename Call> void guarded(const Call &call);

    nb::object adapter_;
    grrl_policy_type type_{};
    std::unique_ptr<nb::python_error> raised_;
};

/* A learner with the memory of its policy. */
class Learner
{
public:
    Learner(const std::string &policy, nb::object adapter, const nb::dict &options,
            const nb::dict &parameters);

    void begin_trial(uint32_t trial);
    void observe(const Frame &frame, bool pushing);
    bool perceive();
    /* None without a link to push */
    nb::object choose();
    nb::dict adopt(int number, int direction);
    nb::tuple learn(bool ended);
    void abandon();
    nb::dict model();
    std::string term();
    nb::tuple usage();
    nb::bytes save();
    void load(const nb::bytes &bytes);
    void clear();

    const grrl_model &native_model() const { return *grrl_perception_model(&learner_->perception); }
    float large_m() const { return learner_->config.large_m; }
    nb::handle adapter() const { return own_ ? own_->adapter() : nb::handle(); }
    void drop_adapter();

private:
    class Use;
    void make_library_policy(const std::string &name, uint32_t capacity, const nb::dict &parameters,
                             grrl_policy *policy);
    void finish();

    std::unique_ptr<OwnPolicy> own_;
    std::vector<std::max_align_t> memory_;
    std::unique_ptr<grrl_learner> learner_;
    bool busy_ = false;
};

/* Where the objects lie that World knows by name. */
void set_object_folder(const std::string &path);

void bind_model(nb::module_ &m);
void bind_perceive(nb::module_ &m);
void bind_learner(nb::module_ &m);
void bind_world(nb::module_ &m);

} // namespace grrl_python

#endif
