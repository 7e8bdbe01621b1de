/*
 * own_policy.cpp: a policy written in Python, as the library calls one.
 *
 * An exception must not pass through the library's C code. It is kept, the library goes on with the
 * first action, and the learner throws it once the library has returned.
 */
#include "native.hpp"

#include <nanobind/stl/tuple.h>

namespace grrl_python
{

namespace
{

size_t no_bytes(uint32_t)
{
    return 0;
}

grrl_status no_init(void *, uint32_t, const void *)
{
    return GRRL_OK;
}

nb::dict view_dict(const grrl_view &view)
{
    return model_dict(*view.perception, *view.model, view.large_m, 1.0);
}

/* What the adapter says of an action: reason, value, lower, upper, phi. */
using Words = std::tuple<int, double, double, double, double>;

void set_words(const Words &words, grrl_choice *choice)
{
    choice->reason = static_cast<uint8_t>(std::get<0>(words));
    choice->value = static_cast<float>(std::get<1>(words));
    choice->lower = static_cast<float>(std::get<2>(words));
    choice->upper = static_cast<float>(std::get<3>(words));
    choice->phi = static_cast<float>(std::get<4>(words));
}

} // namespace

OwnPolicy::OwnPolicy(nb::object adapter) : adapter_(std::move(adapter))
{
    type_.name = "own";
    type_.text = "a policy of Python";
    type_.bytes = no_bytes;
    type_.init = no_init;
    type_.begin_trial = begin_trial;
    type_.choose = choose;
    type_.explain = explain;
    type_.learn = learn;
}

void OwnPolicy::rethrow()
{
    if (raised_ == nullptr)
        return;
    std::unique_ptr<nb::python_error> raised = std::move(raised_);
    throw nb::python_error(std::move(*raised));
}

/* The first exception counts; after one nothing of Python is called until it is thrown. */
template <typename Call> void OwnPolicy::guarded(const Call &call)
{
    if (raised_ != nullptr)
        return;
    try {
        call();
    } catch (nb::python_error &error) {
        raised_ = std::make_unique<nb::python_error>(std::move(error));
    } catch (const std::exception &error) {
        PyErr_SetString(PyExc_TypeError, error.what());
        raised_ = std::make_unique<nb::python_error>();
    }
}

void OwnPolicy::begin_trial(void *self)
{
    OwnPolicy &own = *static_cast<OwnPolicy *>(self);
    own.guarded([&own] { own.adapter_.attr("begin_trial")(); });
}

void OwnPolicy::choose(void *self, const grrl_view *view, grrl_random *random, grrl_choice *choice)
{
    OwnPolicy &own = *static_cast<OwnPolicy *>(self);
    *choice = grrl_choice{};
    choice->reason = GRRL_CHOICE_RULE;
    choice->source = grrl_no_source();
    own.guarded([&] {
        nb::object numbers = nb::cast(PolicyRandom{*random});
        nb::object answer = own.adapter_.attr("choose")(view_dict(*view), numbers);
        auto [link, direction, words] = nb::cast<std::tuple<int, int, Words>>(answer);
        *random = nb::cast<PolicyRandom &>(numbers).state;
        choice->link = static_cast<uint8_t>(link); /* the adapter has checked both */
        choice->direction = static_cast<uint8_t>(direction);
        set_words(words, choice);
    });
}

void OwnPolicy::explain(void *self, const grrl_view *view, grrl_choice *choice)
{
    OwnPolicy &own = *static_cast<OwnPolicy *>(self);
    own.guarded([&] {
        nb::object answer =
            own.adapter_.attr("explain")(view_dict(*view), choice->link, choice->direction);
        set_words(nb::cast<Words>(answer), choice);
    });
}

void OwnPolicy::learn(void *self, const grrl_outcome *outcome, grrl_update *update)
{
    OwnPolicy &own = *static_cast<OwnPolicy *>(self);
    own.guarded([&] {
        nb::object answer = own.adapter_.attr("learn")(
            view_dict(outcome->view), outcome->choice.link, outcome->choice.direction,
            outcome->body_number, static_cast<double>(outcome->reward), outcome->ended);
        update->target = static_cast<float>(nb::cast<double>(answer));
    });
}

} // namespace grrl_python
