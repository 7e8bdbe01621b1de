/*
 * transport.hpp: runs a phase over LCM, with agent and simulator in this process (memq) or the
 * simulator in a child process (udpm). Both give the same results, bit for bit.
 */
#ifndef GRRL_EXPERIMENT_TRANSPORT_HPP
#define GRRL_EXPERIMENT_TRANSPORT_HPP

#include "sides.hpp"

namespace grrl_experiment
{

enum class Transport { MEMQ, UDPM };

/* Both return what the policy learned, and throw std::runtime_error. */
Bytes run_over_memq(const Phase &phase, const Bytes &experience,
                    const WorldSide::OnTrial &on_trial);
Bytes run_over_udpm(const Phase &phase, const Bytes &experience,
                    const WorldSide::OnTrial &on_trial);

inline Bytes run_phase(Transport transport, const Phase &phase, const Bytes &experience,
                       const WorldSide::OnTrial &on_trial)
{
    return transport == Transport::MEMQ ? run_over_memq(phase, experience, on_trial)
                                        : run_over_udpm(phase, experience, on_trial);
}

} // namespace grrl_experiment

#endif
