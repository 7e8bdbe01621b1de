/* push_wrap.hpp: the parts of a push, and the meter that knows which one runs. */
#ifndef GRRL_BENCH_PUSH_WRAP_HPP
#define GRRL_BENCH_PUSH_WRAP_HPP

namespace grrl_bench_push
{

enum Part { PERCEPTION, BOX2D, TRACKER, WIRE, LEARNER, OTHER, PARTS };

/* Counts from here on with this perf_event counter; with -1 the thread's time. */
void meter_start(int counter);

/* Millions of instructions, or milliseconds, of each part without what it calls in others. */
void meter_stop(double part[PARTS]);

} // namespace grrl_bench_push

#endif
