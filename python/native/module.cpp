/* module.cpp: the extension module grrl._native, and the capacities it was built with. */
#include "native.hpp"

#include <cstdlib>

#include "grrl/policies.h"

namespace grrl_python
{

namespace
{

void bind_constants(nb::module_ &m)
{
    m.attr("VERSION") = GRRL_PYTHON_VERSION;
    m.attr("MAX_LINKS") = static_cast<int>(GRRL_MAX_LINKS);
    m.attr("MAX_JOINTS") = static_cast<int>(GRRL_MAX_JOINTS);
    m.attr("MAX_FEATURES") = static_cast<int>(GRRL_MAX_FEATURES);
    m.attr("SETTLING_FRAMES") = static_cast<int>(GRRL_SETTLING_FRAMES);
    nb::list degrees;
    for (int i = 0; i < GRRL_DIRECTIONS; i++)
        degrees.append(static_cast<int>(grrl_direction_deg[i]));
    m.attr("DIRECTIONS_DEG") = nb::tuple(degrees);
    nb::dict policies;
    for (const grrl_policy_type *const *type = grrl_policies; *type != nullptr; type++)
        policies[(*type)->name] = (*type)->text;
    m.attr("POLICIES") = policies;
#ifdef GRRL_PYTHON_WORLD
    m.attr("HAS_WORLD") = true;
#else
    m.attr("HAS_WORLD") = false;
#endif
}

} // namespace

} // namespace grrl_python

NB_MODULE(_native, m)
{
    using namespace grrl_python;
    /* At exit a traceback or a cycle often keeps objects alive, which is no leak of ours. */
    nanobind::set_leak_warnings(std::getenv("GRRL_LEAK_WARNINGS") != nullptr);
    m.doc() = "The C library grrl and the simulated world; grrl's Python modules wrap it.";
    bind_constants(m);
    bind_model(m);
    bind_perceive(m);
    bind_learner(m);
#ifdef GRRL_PYTHON_WORLD
    bind_world(m);
#endif
}
