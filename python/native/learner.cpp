/* learner.cpp: the learner with a policy of the library or of Python. */
#include "native.hpp"

#include <cstring>
#include <stdexcept>

#include "grrl/policies.h"

namespace grrl_python
{

namespace
{

/* A policy's configuration, whatever its type. */
union Configuration {
    std::max_align_t aligned;
    unsigned char bytes[GRRL_POLICY_CONFIG_BYTES];
};

std::string names_of(const grrl_policy_type &type)
{
    std::string names;
    for (size_t i = 0; i < type.n_parameters; i++)
        names += (i == 0 ? "" : ", ") + std::string(type.parameters[i].name);
    return names.empty() ? "none" : names;
}

void set_parameters(const grrl_policy_type &type, const nb::dict &parameters, Configuration &config)
{
    for (auto [key, value] : parameters) {
        std::string name = nb::cast<std::string>(key);
        const grrl_parameter *found = nullptr;
        for (size_t i = 0; i < type.n_parameters; i++)
            if (name == type.parameters[i].name)
                found = &type.parameters[i];
        if (found == nullptr)
            throw nb::value_error(("policy " + std::string(type.name) + " has no parameter " +
                                   name + "; it has: " + names_of(type))
                                      .c_str());
        float number = static_cast<float>(nb::cast<double>(value));
        std::memcpy(config.bytes + found->offset, &number, sizeof number);
        if (type.config_check(config.bytes, nullptr) != GRRL_OK)
            throw nb::value_error((name + " must be " + found->range).c_str());
    }
}

int append_bytes(void *context, const void *bytes, size_t size)
{
    static_cast<std::string *>(context)->append(static_cast<const char *>(bytes), size);
    return 0;
}

struct Reader {
    const char *at;
    size_t left;
};

int take_bytes(void *context, void *bytes, size_t size)
{
    Reader *reader = static_cast<Reader *>(context);
    if (size > reader->left)
        return -1;
    std::memcpy(bytes, reader->at, size);
    reader->at += size;
    reader->left -= size;
    return 0;
}

nb::tuple vec(grrl_vec2 v)
{
    return nb::make_tuple(static_cast<double>(v.x), static_cast<double>(v.y));
}

nb::dict decision_dict(const grrl_decision &decision)
{
    const grrl_choice &choice = decision.choice;
    const grrl_push &push = decision.push;
    nb::dict dict;
    dict["link"] = static_cast<int>(choice.link);
    dict["direction"] = static_cast<int>(choice.direction);
    dict["number"] = static_cast<int>(decision.body_number);
    dict["reason"] = static_cast<int>(choice.reason);
    dict["source"] = static_cast<int>(choice.source.kind);
    dict["distance"] = static_cast<int>(choice.source.distance);
    dict["index"] = choice.source.index == GRRL_NO_ENTRY ? int64_t{-1} : choice.source.index;
    dict["value"] = static_cast<double>(choice.value);
    dict["lower"] = static_cast<double>(choice.lower);
    dict["upper"] = static_cast<double>(choice.upper);
    dict["phi"] = static_cast<double>(choice.phi);
    dict["push"] =
        nb::make_tuple(vec(push.start_m), vec(push.end_m), static_cast<double>(push.travel_m),
                       static_cast<double>(push.speed_m_s), static_cast<double>(push.force_n),
                       static_cast<double>(push.timeout_s));
    return dict;
}

grrl_learner_config config_from(const nb::dict &options)
{
    grrl_learner_config config;
    grrl_learner_config_default(&config);
    config.seed = nb::cast<uint64_t>(options["seed"]);
    config.perception.noise_m = static_cast<float>(nb::cast<double>(options["noise_m"]));
    config.large_m = static_cast<float>(nb::cast<double>(options["large_m"]));
    config.trial_reward = static_cast<float>(nb::cast<double>(options["trial_reward"]));
    return config;
}

} // namespace

/* A policy of Python is called within the learner and must not call it again. */
class Learner::Use
{
public:
    explicit Use(Learner &learner) : learner_(learner)
    {
        if (learner.busy_)
            throw std::runtime_error("a policy may not call the learner that calls it");
        if (learner.learner_ == nullptr)
            throw std::runtime_error("this learner is being taken down");
        learner.busy_ = true;
    }
    ~Use() { learner_.busy_ = false; }
    Use(const Use &) = delete;
    Use &operator=(const Use &) = delete;

private:
    Learner &learner_;
};

Learner::Learner(const std::string &policy, nb::object adapter, const nb::dict &options,
                 const nb::dict &parameters)
    : learner_(std::make_unique<grrl_learner>())
{
    grrl_learner_config config = config_from(options);
    grrl_policy made{};
    if (adapter.is_none()) {
        make_library_policy(policy, nb::cast<uint32_t>(options["capacity"]), parameters, &made);
    } else {
        own_ = std::make_unique<OwnPolicy>(std::move(adapter));
        made = own_->policy();
    }
    must(grrl_learner_init(learner_.get(), &config, made),
         "noise, large or trial_reward of the learner");
    finish();
}

void Learner::make_library_policy(const std::string &name, uint32_t capacity,
                                  const nb::dict &parameters, grrl_policy *policy)
{
    const grrl_policy_type *type = grrl_policy_find(name.c_str());
    if (type == nullptr)
        throw nb::value_error(("there is no policy " + name).c_str());
    Configuration config;
    if (type->config_default != nullptr)
        type->config_default(config.bytes);
    set_parameters(*type, parameters, config);
    size_t bytes = type->bytes(capacity);
    memory_.resize(bytes / sizeof(std::max_align_t) + 1);
    must(grrl_policy_make(type, memory_.data(), bytes, capacity,
                          type->config_default != nullptr ? config.bytes : nullptr, policy),
         "capacity of the policy");
}

/* After each call of the library that may have called Python. */
void Learner::finish()
{
    if (own_ == nullptr)
        return;
    try {
        own_->rethrow();
    } catch (nb::python_error &) {
        learner_->phase = 0; /* what the trial would come to is not known: idle */
        throw;
    }
}

void Learner::begin_trial(uint32_t trial)
{
    Use use(*this);
    grrl_learner_begin_trial(learner_.get(), trial);
    finish();
}

void Learner::observe(const Frame &frame, bool pushing)
{
    Use use(*this);
    grrl_frame view = frame.view();
    grrl_learner_observe(learner_.get(), &view, pushing);
}

bool Learner::perceive()
{
    Use use(*this);
    grrl_status status = grrl_learner_perceive(learner_.get());
    if (status == GRRL_ERR_ORDER)
        throw std::runtime_error("perceive: there is no trial; begin_trial comes first");
    if (status != GRRL_ERR_NONE)
        must(status, "perceive");
    return status == GRRL_OK;
}

nb::object Learner::choose()
{
    Use use(*this);
    grrl_decision decision;
    grrl_status status = grrl_learner_choose(learner_.get(), &decision);
    finish();
    if (status == GRRL_ERR_NONE)
        return nb::none();
    if (status == GRRL_ERR_ORDER)
        throw std::runtime_error("choose: perceive comes first, and learn after each push");
    must(status, "choose");
    return decision_dict(decision);
}

nb::dict Learner::adopt(int number, int direction)
{
    Use use(*this);
    if (direction < 0 || direction >= GRRL_DIRECTIONS)
        throw nb::value_error("adopt: direction must be an index from 0 to 5");
    grrl_decision decision;
    grrl_status status = grrl_learner_adopt(learner_.get(), static_cast<uint16_t>(number),
                                            static_cast<uint8_t>(direction), false, &decision);
    finish();
    if (status == GRRL_ERR_ORDER)
        throw std::runtime_error("adopt: perceive comes first, and learn after each push");
    if (status == GRRL_ERR_NONE)
        throw nb::value_error("adopt: the model has no such body");
    must(status, "adopt");
    return decision_dict(decision);
}

nb::tuple Learner::learn(bool ended)
{
    Use use(*this);
    grrl_update update;
    grrl_status status = grrl_learner_learn(learner_.get(), ended, &update);
    finish();
    if (status == GRRL_ERR_ORDER)
        throw std::runtime_error("learn: choose, the push and perceive come first");
    must(status, "learn");
    return nb::make_tuple(static_cast<double>(update.reward), static_cast<double>(update.target),
                          update.index == GRRL_NO_ENTRY ? int64_t{-1} : update.index);
}

void Learner::abandon()
{
    Use use(*this);
    grrl_learner_abandon_trial(learner_.get());
    finish();
}

nb::dict Learner::model()
{
    Use use(*this);
    return model_dict(learner_->perception, native_model(), large_m(), 1.0);
}

std::string Learner::term()
{
    Use use(*this);
    return term_of(native_model(), large_m());
}

nb::tuple Learner::usage()
{
    Use use(*this);
    grrl_usage usage = grrl_learner_usage(learner_.get());
    return nb::make_tuple(usage.n, usage.capacity, usage.evictions);
}

nb::bytes Learner::save()
{
    Use use(*this);
    std::string bytes;
    grrl_io io{&bytes, append_bytes, nullptr};
    must(grrl_learner_save(learner_.get(), &io), "save");
    return nb::bytes(bytes.data(), bytes.size());
}

void Learner::load(const nb::bytes &bytes)
{
    Use use(*this);
    Reader reader{static_cast<const char *>(bytes.data()), bytes.size()};
    grrl_io io{&reader, nullptr, take_bytes};
    grrl_status status = grrl_learner_load(learner_.get(), &io);
    if (status == GRRL_ERR_IO)
        throw nb::value_error("load: the store ends early");
    must(status, "load");
}

void Learner::clear()
{
    Use use(*this);
    grrl_learner_clear(learner_.get());
}

void Learner::drop_adapter()
{
    if (own_ == nullptr)
        return;
    learner_.reset();
    own_->adapter().reset();
}

/* --- cycles through a policy that knows its learner ------------------------------------------- */

namespace
{

int traverse(PyObject *self, visitproc visit, void *arg)
{
    Py_VISIT(Py_TYPE(self));
    if (!nb::inst_ready(self))
        return 0;
    nb::handle adapter = nb::inst_ptr<Learner>(self)->adapter();
    Py_VISIT(adapter.ptr());
    return 0;
}

int clear_cycle(PyObject *self)
{
    if (nb::inst_ready(self))
        nb::inst_ptr<Learner>(self)->drop_adapter();
    return 0;
}

PyType_Slot slots[] = {{Py_tp_traverse, reinterpret_cast<void *>(traverse)},
                       {Py_tp_clear, reinterpret_cast<void *>(clear_cycle)},
                       {0, nullptr}};

} // namespace

void bind_learner(nb::module_ &m)
{
    nb::class_<PolicyRandom>(m, "Random",
                             "Random numbers of a policy: the same seed, the same run.")
        .def(
            "below",
            [](PolicyRandom &random, uint32_t count) {
                if (count == 0)
                    throw nb::value_error("below: count must be 1 or more");
                return grrl_random_below(&random.state, count);
            },
            nb::arg("count"), "Uniform over 0 .. count - 1.")
        .def(
            "uniform",
            [](PolicyRandom &random) {
                return static_cast<double>(grrl_random_uniform(&random.state));
            },
            "Uniform in [0, 1).");
    nb::class_<Learner>(m, "Learner", nb::type_slots(slots))
        .def(nb::init<const std::string &, nb::object, const nb::dict &, const nb::dict &>(),
             nb::arg("policy"), nb::arg("adapter").none(), nb::arg("options"),
             nb::arg("parameters"))
        .def("begin_trial", &Learner::begin_trial, nb::arg("trial"))
        .def("observe", &Learner::observe, nb::arg("frame"), nb::arg("pushing"))
        .def("perceive", &Learner::perceive)
        .def("choose", &Learner::choose, nb::sig("def choose(self) -> dict | None"))
        .def("adopt", &Learner::adopt, nb::arg("number"), nb::arg("direction"))
        .def("learn", &Learner::learn, nb::arg("ended"))
        .def("abandon", &Learner::abandon)
        .def("model", &Learner::model)
        .def("term", &Learner::term)
        .def("usage", &Learner::usage)
        .def("save", &Learner::save)
        .def("load", &Learner::load, nb::arg("bytes"))
        .def("clear", &Learner::clear);
}

} // namespace grrl_python
